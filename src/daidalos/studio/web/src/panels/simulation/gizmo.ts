// The handles that move, rotate and scale a model.
import { Matrix4, Object3D, Vector3 } from "three";
import { TransformControls } from "three/examples/jsm/controls/TransformControls.js";
import type { Pose } from "../../generated/geometry_msgs";
import { FIELD_OF_VIEW_DEG } from "../../scene/view";
import type { Viewport } from "../../scene/viewport";

export type Motion = "move" | "turn" | "scale";

/** Steps while Ctrl is pressed. */
export const SNAP = { move: 0.25, turn: Math.PI / 12, scale: 0.25 } as const;

const MODES = { move: "translate", turn: "rotate", scale: "scale" } as const;
/** How far handles reach, in radii of the model; and how large they are at least and at most, by the library's measure. */
const REACH = 1.25;
const SIZES = [0.85, 2.2] as const;
/** The library's measure: handles reach this far, in metres, for a size of 1 and a metre's distance. */
const REACH_PER_SIZE = (0.5 / 4) * 1.9 * Math.tan((FIELD_OF_VIEW_DEG * Math.PI) / 360);
const COLORS = ["#f2555a", "#5fc26b", "#4d8dff", "#ffd166"] as const;
/** The handle in the middle moves in the image plane: it is not used, dragging the model moves it along the ground. */
const LOOSE = "XYZ";

export class Gizmo {
  private readonly controls: TransformControls;
  private readonly handle = new Object3D();
  private readonly start = new Matrix4();

  constructor(private readonly viewport: Viewport) {
    // Without an element: the editor passes the pointer's events on, so that the camera does not rotate as well.
    this.controls = new TransformControls(viewport.view.camera);
    this.controls.setColors(...COLORS);
    this.controls.showE = this.controls.showXYZE = false;
    this.controls.addEventListener("change", viewport.invalidate);
    viewport.scene.add(this.handle, this.controls.getHelper());
  }

  get isDragged(): boolean {
    return this.controls.dragging;
  }

  /** The motion of the handles since `place`. */
  get motion(): Matrix4 {
    this.handle.updateMatrix();
    return this.handle.matrix.clone().multiply(this.start.clone().invert());
  }

  /** The factors along the model's axes. */
  get factors(): Vector3 {
    return this.handle.scale.clone();
  }

  /** Place the handles at a model of a radius. */
  place(motion: Motion, { position: p, orientation: o }: Pose, radius: number): void {
    this.handle.position.set(p.x, p.y, p.z);
    this.handle.quaternion.set(o.x, o.y, o.z, o.w);
    this.handle.scale.setScalar(1);
    this.handle.updateMatrix();
    this.start.copy(this.handle.matrix);
    const distance = this.handle.position.distanceTo(this.viewport.view.camera.position);
    const size = (REACH * radius) / (REACH_PER_SIZE * distance);
    this.controls.setSize(Math.min(SIZES[1], Math.max(SIZES[0], size)));
    this.controls.setMode(MODES[motion]);
    this.controls.setSpace(motion === "move" ? "world" : "local");
    if (this.controls.object !== this.handle) {
      this.controls.attach(this.handle);
    }
  }

  hide(): void {
    if (this.controls.object) {
      this.controls.detach();
    }
  }

  /** Where the handle along an axis of the world or, for turning and scaling, of the model ends. */
  tip(axis: "x" | "y" | "z"): Vector3 {
    const distance = this.handle.position.distanceTo(this.viewport.view.camera.position);
    const along = new Vector3().setComponent("xyz".indexOf(axis), 0.9 * REACH_PER_SIZE * this.controls.size * distance);
    return (this.controls.space === "local" ? along.applyQuaternion(this.handle.quaternion) : along).add(
      this.handle.position,
    );
  }

  /** Highlight the handle under a pixel; false where there is none. */
  hover(x: number, y: number): boolean {
    this.controls.camera = this.viewport.view.camera;
    this.controls.pointerHover(this.pointer(x, y));
    if (this.controls.mode === "translate" && this.controls.axis === LOOSE) {
      this.controls.axis = null;
    }
    return this.controls.axis !== null;
  }

  /** Start to drag the handle under a pixel; false where there is none. */
  press(x: number, y: number): boolean {
    if (!this.hover(x, y)) {
      return false;
    }
    // The plane in which a handle moves depends on the handle, and may not have been drawn since.
    this.controls.getHelper().updateMatrixWorld(true);
    this.controls.pointerDown(this.pointer(x, y));
    return this.controls.dragging;
  }

  drag(x: number, y: number, snaps: boolean): void {
    this.controls.setTranslationSnap(snaps ? SNAP.move : null);
    this.controls.setRotationSnap(snaps ? SNAP.turn : null);
    this.controls.setScaleSnap(snaps ? SNAP.scale : null);
    this.controls.pointerMove(this.pointer(x, y, -1));
  }

  release(): void {
    this.controls.pointerUp(this.pointer(0, 0));
    this.controls.axis = null;
  }

  dispose(): void {
    this.controls.detach();
    // The library's `dispose` removes listeners from an element, which these controls do not have.
    const helper = this.controls.getHelper();
    helper.dispose();
    helper.removeFromParent();
    this.handle.removeFromParent();
  }

  /** As the library's own events have it: from -1 to 1 across the canvas. */
  private pointer(x: number, y: number, button = 0): PointerEvent {
    const { width, height } = this.viewport;
    return { x: (2 * x) / width - 1, y: 1 - (2 * y) / height, button } as PointerEvent;
  }
}
