// The canvas: renders the scene when something has changed, and no more finely than the machine can.
import {
  Color,
  type Intersection,
  Object3D,
  Raycaster,
  Scene,
  Vector2,
  Vector3,
  WebGLRenderer,
  PCFShadowMap,
} from "three";
import { gradientOf } from "./backdrop";
import { beginsFine } from "./graphics";
import { Lights } from "./lights";
import { DAYLIGHT, type Look } from "./looks";
import { Quality } from "./quality";
import { View } from "./view";

Object3D.DEFAULT_UP.set(0, 0, 1);

export class Viewport {
  readonly scene = new Scene();
  readonly view: View;
  readonly lights = new Lights();
  private lookNow = DAYLIGHT;
  private background = "";
  readonly canvas: HTMLCanvasElement;
  readonly quality = new Quality();
  private readonly renderer: WebGLRenderer;
  private readonly raycaster = new Raycaster();
  /** How often it was drawn. */
  drawn = 0;
  private dirty = true;
  private size = new Vector2(1, 1);

  constructor(private readonly container: HTMLElement) {
    // Transparent: sky and ground are the container's background, which costs nothing here.
    this.renderer = new WebGLRenderer({
      antialias: beginsFine,
      alpha: true,
      stencil: true,
      powerPreference: "high-performance",
    });
    this.renderer.setClearColor(new Color(0), 0);
    this.renderer.shadowMap.type = PCFShadowMap;
    this.canvas = this.renderer.domElement;
    this.canvas.tabIndex = 0;
    this.canvas.setAttribute("role", "img");
    this.canvas.setAttribute("aria-label", "3-D view of the robot's world");
    this.canvas.addEventListener("webglcontextrestored", this.invalidate);
    container.append(this.canvas);
    this.view = new View(this.canvas);
    this.view.onChange = () => (this.dirty = true);
    this.scene.add(this.lights.object);
    this.applyQuality();
  }

  /** Sky, ground and light. */
  set look(look: Look) {
    this.lights.look = look;
    this.lookNow = look;
    this.invalidate();
  }

  get width(): number {
    return this.size.x;
  }

  get height(): number {
    return this.size.y;
  }

  get aspect(): number {
    return this.size.x / this.size.y;
  }

  /** Something looks different now, and so may its shadow; a camera that moves leaves shadows as they are. */
  invalidate = (): void => {
    this.dirty = true;
    this.lights.refresh();
  };

  resize(width: number, height: number): void {
    if (width < 1 || height < 1 || (width === this.size.x && height === this.size.y)) {
      return;
    }
    this.size.set(width, height);
    this.renderer.setSize(width, height);
    this.view.resize(width, height);
    // At once: a canvas that was resized is empty until it is drawn.
    this.render();
  }

  /** Draw if anything changed; `page` is the page's clock in seconds. */
  frame(page: number): void {
    if (this.view.update()) {
      this.dirty = true;
    }
    if (this.dirty && this.quality.isDue(page)) {
      if (this.quality.judge(page)) {
        this.applyQuality();
      }
      this.render();
    }
  }

  /** Where a point of the scene is on the canvas, in pixels from its upper left corner. */
  project(point: Vector3): { x: number; y: number } {
    const at = point.clone().project(this.view.camera);
    return { x: ((at.x + 1) / 2) * this.size.x, y: ((1 - at.y) / 2) * this.size.y };
  }

  /** Where the ray through a pixel meets the ground. */
  groundAt(x: number, y: number): Vector3 | undefined {
    return this.planeAt(x, y, 0);
  }

  /** Where the ray through a pixel meets the level plane at a height. */
  planeAt(x: number, y: number, height: number): Vector3 | undefined {
    const { origin, direction } = this.rayThrough(x, y);
    const along = (height - origin.z) / direction.z;
    // Beyond the horizon or behind the camera there is no ground.
    return along > 0 && along < 1e4 ? origin.clone().addScaledVector(direction, along) : undefined;
  }

  /** The nearest surface under a pixel, otherwise the ground. */
  surfaceAt(x: number, y: number): Vector3 | undefined {
    return this.hitAt(x, y)?.point ?? this.groundAt(x, y);
  }

  /** The nearest thing under a pixel, and where it is hit. */
  hitAt(x: number, y: number): Intersection | undefined {
    this.rayThrough(x, y);
    return this.nearest();
  }

  /** Whether nothing is between two points, but for what is within a distance of the second. */
  sees(from: Vector3, to: Vector3, within: number): boolean {
    const along = to.clone().sub(from);
    this.raycaster.ray.set(from, along.clone().normalize());
    const hit = this.nearest();
    return !hit || hit.distance > along.length() - within;
  }

  dispose(): void {
    this.view.dispose();
    this.renderer.dispose();
    this.canvas.remove();
  }

  private rayThrough(x: number, y: number): Raycaster["ray"] {
    const at = new Vector2((x / this.size.x) * 2 - 1, 1 - (y / this.size.y) * 2);
    this.view.camera.updateMatrixWorld();
    this.raycaster.setFromCamera(at, this.view.camera);
    return this.raycaster.ray;
  }

  /** The nearest thing that the ray meets. */
  private nearest(): Intersection | undefined {
    const pickable: Object3D[] = [];
    this.scene.traverseVisible((object) => {
      if (object.userData.pickable) {
        pickable.push(object);
      }
    });
    return this.raycaster.intersectObjects(pickable, false)[0];
  }

  private drawBackground(): void {
    const background = gradientOf(this.lookNow, this.view.outlook);
    if (background !== this.background) {
      this.background = this.container.style.background = background;
    }
  }

  private applyQuality(): void {
    this.renderer.setPixelRatio(this.quality.pixelRatio);
    this.renderer.shadowMap.enabled = this.quality.shadows === "soft";
    this.lights.shadows = this.quality.shadows;
    this.dirty = true;
  }

  private render(): void {
    this.dirty = false;
    this.drawn++;
    this.drawBackground();
    this.renderer.render(this.scene, this.view.camera);
    this.lights.flat.draw(this.renderer, this.scene, this.view.camera);
  }
}
