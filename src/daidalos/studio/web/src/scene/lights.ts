// Light that shapes the robot, and a soft shadow that puts it on the ground.
import { DirectionalLight, Group, HemisphereLight, Mesh, PlaneGeometry, ShadowMaterial, Vector3 } from "three";
import { FlatShadows } from "./flat_shadows";
import { Layer } from "./layers";
import type { Look } from "./looks";
import type { Shadows } from "./quality";

/** The shadow is drawn only near what the camera follows: software renderers pay for every pixel of it. */
const SHADOW_RADIUS_M = 2.5;
/** Who looks from afar sees it farther, in steps, so that its edges do not creep. */
const SHADOW_STEP = 1.25;
const SHADOW_PER_DISTANCE = 0.75;
const MAX_STEPS = 8;
const SHADE = 0x05080d;
const SUN_OFFSET = [1.6, -2.2, 4.2] as const;

export class Lights {
  readonly object = new Group();
  private readonly sun = new DirectionalLight(0xffffff);
  private readonly sky = new HemisphereLight(0xf4f7ff, 0x7d828c);
  private readonly fill = new DirectionalLight(0xbfd4ff);
  private readonly ground: Mesh;
  private steps = -1;
  private readonly shade = new ShadowMaterial({ color: SHADE, opacity: 0.34, depthWrite: false });
  readonly flat = new FlatShadows(new Vector3(...SUN_OFFSET), SHADE);

  constructor() {
    this.sky.position.set(0, 0, 1);
    this.fill.position.set(-3, 2, 1.5);
    const { shadow } = this.sun;
    shadow.mapSize.set(2048, 2048);
    shadow.autoUpdate = false;
    shadow.normalBias = 0.01;
    this.sun.castShadow = true;
    this.ground = new Mesh(new PlaneGeometry(2 * SHADOW_RADIUS_M, 2 * SHADOW_RADIUS_M), this.shade);
    this.ground.receiveShadow = true;
    this.ground.renderOrder = Layer.SHADOW;
    this.object.add(this.sky, this.fill, this.sun, this.sun.target, this.ground);
    this.follow({ x: 0, y: 0, z: 0 } as Vector3);
  }

  set shadows(shadows: Shadows) {
    this.sun.castShadow = this.ground.visible = shadows === "soft";
    this.flat.on = shadows === "flat";
    this.refresh();
  }

  /** Draw the shadow's map anew with the next frame: something that casts a shadow may have changed. */
  refresh(): void {
    this.sun.shadow.needsUpdate = true;
  }

  set look({ sun, sky, fill, bounce, shade }: Look) {
    this.shade.opacity = this.flat.opacity = shade;
    [this.sun.intensity, this.sky.intensity, this.fill.intensity] = [sun, sky, fill];
    this.sky.groundColor.set(bounce);
  }

  /** Keep the shadow under what is looked at, and as wide as may be seen from a distance in metres. */
  follow(center: Pick<Vector3, "x" | "y">, distance = 0): void {
    const wanted = Math.log((distance * SHADOW_PER_DISTANCE) / SHADOW_RADIUS_M) / Math.log(SHADOW_STEP);
    const steps = Math.min(MAX_STEPS, Math.max(0, Math.round(wanted)));
    const { x: oldX, y: oldY } = this.ground.position;
    if (steps !== this.steps || center.x !== oldX || center.y !== oldY) {
      this.refresh();
    }
    if (steps !== this.steps) {
      this.steps = steps;
      this.widen();
    }
    const factor = SHADOW_STEP ** steps;
    const [x, y, z] = SUN_OFFSET.map((offset) => offset * factor) as [number, number, number];
    this.sun.target.position.set(center.x, center.y, 0);
    this.sun.position.set(center.x + x, center.y + y, z);
    this.ground.position.set(center.x, center.y, 0.004);
  }

  private widen(): void {
    const factor = SHADOW_STEP ** this.steps;
    const radius = SHADOW_RADIUS_M * factor;
    const { shadow } = this.sun;
    const { camera } = shadow;
    shadow.radius = Math.max(2, 5 / factor); // in pixels of the map, which are larger then
    [camera.left, camera.bottom, camera.right, camera.top] = [-radius, -radius, radius, radius];
    [camera.near, camera.far] = [0.5 * factor, 12 * factor];
    camera.updateProjectionMatrix();
    this.ground.scale.set(factor, factor, 1);
  }
}
