// The cameras and how the mouse moves them: RViz's orbit view and its top-down orthographic view.
import { MOUSE, OrthographicCamera, PerspectiveCamera, TOUCH, Vector3, type Camera } from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import type { Outlook } from "./backdrop";
import type { View as ViewState } from "../generated/arrangement";

export type { ViewState };
export type ViewKind = ViewState["kind"];

export const HOME: ViewState = { kind: "orbit", focus: [0, 0, 0], distance: 6.5, yaw: -2.3, pitch: 0.62 };

export const FIELD_OF_VIEW_DEG = 45;
const NEAR_M = 0.02;
/** Of the distance to the focus: nothing nearer is drawn, so that depths far away are told apart. */
const NEAR_SHARE = 0.005;
const FAR_M = 2000;

/** Where an orbit view's camera is. */
export function positionOf({ focus, distance, yaw, pitch }: ViewState): Vector3 {
  const level = Math.cos(pitch) * distance;
  const offset = new Vector3(Math.cos(yaw) * level, Math.sin(yaw) * level, Math.sin(pitch) * distance);
  return offset.add(new Vector3().fromArray(focus));
}

export class View {
  onChange: () => void = () => undefined;
  /** Whether the user has used the mouse in the view. */
  isMoved = false;
  private readonly perspective = new PerspectiveCamera(FIELD_OF_VIEW_DEG, 1, NEAR_M, FAR_M);
  private readonly orthographic = new OrthographicCamera(-1, 1, 1, -1, -FAR_M, FAR_M);
  private readonly orbit: OrbitControls;
  private readonly top: OrbitControls;
  private kindNow: ViewKind = "orbit";
  private leftIsFree = true;
  private aspect = 1;

  constructor(element: HTMLElement) {
    for (const camera of [this.perspective, this.orthographic]) {
      camera.up.set(0, 0, 1);
    }
    this.orbit = new OrbitControls(this.perspective, element);
    this.orbit.maxPolarAngle = Math.PI * 0.495;
    this.orbit.minDistance = 0.15;
    this.orbit.maxDistance = FAR_M / 4;
    this.orbit.touches = { ONE: TOUCH.ROTATE, TWO: TOUCH.DOLLY_PAN };
    this.top = new OrbitControls(this.orthographic, element);
    [this.top.minPolarAngle, this.top.maxPolarAngle] = [0, 0];
    [this.top.minZoom, this.top.maxZoom] = [0.002, 20];
    this.top.touches = { ONE: TOUCH.PAN, TWO: TOUCH.DOLLY_ROTATE };
    for (const controls of [this.orbit, this.top]) {
      controls.enableDamping = true;
      controls.dampingFactor = 0.18;
      controls.zoomToCursor = true;
      controls.zoomSpeed = 1.2;
      controls.addEventListener("change", () => this.onChange());
    }
    // Any press, also with a tool: what the user aims at must not move away.
    element.addEventListener("pointerdown", () => (this.isMoved = true), { capture: true });
    element.addEventListener("wheel", () => (this.isMoved = true), { capture: true, passive: true });
    this.restore(HOME);
  }

  get kind(): ViewKind {
    return this.kindNow;
  }

  get camera(): Camera & { updateProjectionMatrix(): void } {
    return this.kindNow === "orbit" ? this.perspective : this.orthographic;
  }

  get focus(): Vector3 {
    return this.controls.target;
  }

  /** How far one sees around the focus, in metres. */
  get reach(): number {
    return this.kindNow === "orbit"
      ? this.perspective.position.distanceTo(this.orbit.target)
      : 1 / this.orthographic.zoom;
  }

  /** What it sees of the horizon; undefined from straight above. */
  get outlook(): Outlook | undefined {
    return this.kindNow === "top"
      ? undefined
      : {
          pitch: Math.PI / 2 - this.orbit.getPolarAngle(),
          half: (FIELD_OF_VIEW_DEG * Math.PI) / 360,
          height: this.perspective.position.z,
          reach: this.reach,
        };
  }

  /** Whether a point is in front of the camera. */
  isAhead(point: Vector3): boolean {
    const { camera } = this;
    return point.clone().sub(camera.position).dot(camera.getWorldDirection(new Vector3())) > 0;
  }

  /** Metres that one pixel spans at a point. */
  metresPerPixel(at: Vector3, height: number): number {
    if (this.kindNow === "top") {
      return 2 / this.orthographic.zoom / height;
    }
    const depth = at.clone().sub(this.perspective.position).dot(this.perspective.getWorldDirection(new Vector3()));
    return (2 * Math.max(NEAR_M, depth) * Math.tan((FIELD_OF_VIEW_DEG * Math.PI) / 360)) / height;
  }

  resize(width: number, height: number): void {
    this.aspect = width / Math.max(1, height);
    this.perspective.aspect = this.aspect;
    this.perspective.updateProjectionMatrix();
    [this.orthographic.left, this.orthographic.right] = [-this.aspect, this.aspect];
    this.orthographic.updateProjectionMatrix();
  }

  /** Let a tool have the left button, or give it back to the camera. */
  set leftButton(moves: boolean) {
    this.leftIsFree = moves;
    this.applyButtons();
  }

  switchTo(kind: ViewKind): void {
    if (kind !== this.kindNow) {
      this.restore({ ...this.state(), kind });
    }
  }

  /** Move the view along with something that moves. */
  shift(by: Vector3): void {
    this.focus.add(by);
    this.camera.position.add(by);
  }

  lookAt(point: Vector3): void {
    this.shift(point.clone().sub(this.focus));
    this.onChange();
  }

  state(): ViewState {
    const { x, y, z } = this.focus;
    const orbit = this.kindNow === "orbit";
    return {
      kind: this.kindNow,
      focus: [x, y, z],
      distance: this.reach * (orbit ? 1 : 1 / Math.tan((FIELD_OF_VIEW_DEG * Math.PI) / 360)),
      yaw: orbit ? this.orbit.getAzimuthalAngle() - Math.PI / 2 : this.lastYaw,
      pitch: orbit ? Math.PI / 2 - this.orbit.getPolarAngle() : this.lastPitch,
    };
  }

  restore(state: ViewState): void {
    this.kindNow = state.kind;
    [this.lastYaw, this.lastPitch] = [state.yaw, state.pitch];
    this.controls.target.fromArray(state.focus);
    if (state.kind === "orbit") {
      this.perspective.position.copy(positionOf(state));
    } else {
      this.orthographic.zoom = 1 / (state.distance * Math.tan((FIELD_OF_VIEW_DEG * Math.PI) / 360));
      this.orthographic.position.copy(this.top.target).setZ(this.top.target.z + 10);
      this.orthographic.updateProjectionMatrix();
    }
    this.applyButtons();
    this.controls.update();
    this.onChange();
  }

  /** Let the damping go on; return whether the view still moves. */
  update(): boolean {
    const near = Math.max(NEAR_M, NEAR_SHARE * this.perspective.position.distanceTo(this.orbit.target));
    if (Math.abs(near / this.perspective.near - 1) > 0.1) {
      this.perspective.near = near;
      this.perspective.updateProjectionMatrix();
    }
    return this.controls.update();
  }

  dispose(): void {
    this.orbit.dispose();
    this.top.dispose();
  }

  private lastYaw = HOME.yaw;
  private lastPitch = HOME.pitch;

  private get controls(): OrbitControls {
    return this.kindNow === "orbit" ? this.orbit : this.top;
  }

  private applyButtons(): void {
    const orbit = this.kindNow === "orbit";
    this.orbit.enabled = orbit;
    this.top.enabled = !orbit;
    const left = this.leftIsFree ? (orbit ? MOUSE.ROTATE : MOUSE.PAN) : null;
    this.controls.mouseButtons = { LEFT: left, MIDDLE: MOUSE.PAN, RIGHT: MOUSE.DOLLY };
  }
}
