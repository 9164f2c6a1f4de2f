// Mouse and keyboard in the simulated world: select, drag, insert and delete models.
import { signal } from "@preact/signals";
import { Euler, Matrix4, Quaternion, Vector3 } from "three";
import type { Pose } from "../../generated/geometry_msgs";
import type { ColorRGBA } from "../../generated/std_msgs";
import { Marker } from "../../generated/visualization_msgs";
import { Gizmo, type Motion, SNAP } from "./gizmo";
import type { Resource, Simulator } from "./simulator";
import { movedPose, type Stage } from "./stage";
import { UndoStack } from "./undo_stack";

export type Mode = "look" | Motion | "insert";
export type Shape = "box" | "sphere" | "cylinder";

const CLICK_PX = 4;
const ROTATION_PER_PX = 0.012;
const SCALE_PER_PX = 0.007;
const MIN_FACTOR = 0.02;
/** Size of the placeholder of a model that is to be inserted. */
const UNKNOWN_SIZE_M = 0.4;
/** Colours of inserted shapes, in turn. */
const PALETTE = ["#e2a355", "#4d8dff", "#5fc26b", "#f2555a", "#a78bfa", "#3fc1c9"];
const MARKERS: Record<Shape, number> = {
  box: Marker.CUBE,
  sphere: Marker.SPHERE,
  cylinder: Marker.CYLINDER,
};
/** Gazebo's keys, without Ctrl. */
const KEYS: Readonly<Record<string, Mode>> = { t: "move", r: "turn", s: "scale" };

interface Drag {
  name: string;
  mode: Motion;
  /** Whether a handle is dragged rather than the model itself. */
  usesGizmo: boolean;
  from: Vector3;
  x: number;
  y: number;
  pose: Pose;
  motion: Matrix4;
  factors: Vector3;
}

export class Editor {
  readonly mode = signal<Mode>("look");
  /** What is inserted next. */
  readonly template = signal<Shape | Resource>("box");
  readonly size = signal(0.3);
  readonly mass = signal(1);
  readonly error = signal("");
  readonly undoStack = new UndoStack();
  private readonly gizmo: Gizmo;
  private drag: Drag | undefined;
  private pressed: { x: number; y: number } | undefined;
  private inserted = 0;
  /** The last pose that was sent, until the simulator has responded. */
  private sending: Promise<void> | undefined;
  private running = 0;
  private readonly listeners = new AbortController();

  constructor(
    private readonly container: HTMLElement,
    private readonly stage: Stage,
    private readonly simulator: Simulator,
  ) {
    this.gizmo = new Gizmo(stage.viewport);
    const { signal } = this.listeners;
    // Before the camera's listeners: dragging a model does not rotate the view.
    container.addEventListener("pointerdown", (event) => this.down(event), { signal, capture: true });
    container.addEventListener("pointermove", (event) => this.move(event), { signal });
    container.addEventListener("pointerup", (event) => this.up(event), { signal });
    container.addEventListener("pointercancel", () => this.cancel(), { signal });
    container.addEventListener("pointerleave", () => this.stage.showGhost(undefined), { signal });
    container.addEventListener("dblclick", (event) => this.focusOn(event), { signal });
    container.addEventListener("contextmenu", (event) => event.preventDefault(), { signal });
    // Before the keys of the 3-D view.
    document.addEventListener("keydown", (event) => this.key(event), { signal, capture: true });
  }

  setMode(mode: Mode, template: Shape | Resource = this.template.value): void {
    this.cancel();
    this.mode.value = mode;
    this.template.value = template;
    this.stage.showGhost(undefined);
    this.stage.viewport.canvas.style.cursor = mode === "insert" ? "crosshair" : "";
  }

  /** Delete the selected model. */
  async remove(): Promise<void> {
    const name = this.stage.selected.value;
    if (name && (await this.run(() => this.simulator.remove(name)))) {
      this.undoStack.push(name, "delete", () => this.restore(name));
    }
  }

  /** Undo the last step. */
  undo(): void {
    const last = this.undoStack.pop();
    if (last) {
      void this.run(last.undo);
    }
  }

  /** Whether a request to the simulator is pending. */
  get isBusy(): boolean {
    return this.running > 0 || this.sending !== undefined;
  }

  /** Run a request to the simulator and show the new shapes; an error is shown to the user. */
  async run(work: () => Promise<unknown>): Promise<boolean> {
    this.error.value = "";
    this.running++;
    try {
      await this.sending; // requests may overtake each other: this one must be the last
      await work();
      this.stage.show(await this.simulator.look());
      return true;
    } catch (error) {
      this.error.value = error instanceof Error ? error.message : String(error);
      return false;
    } finally {
      this.running--;
    }
  }

  /** Place the handles at the selected model; once per frame. */
  follow(): void {
    if (this.drag) {
      return;
    }
    const mode = this.mode.value;
    const pose = mode === "look" || mode === "insert" ? undefined : this.stage.poseOf(this.stage.selected.value);
    if (pose && mode !== "look" && mode !== "insert") {
      this.gizmo.place(mode, pose, this.stage.radius);
    } else {
      this.gizmo.hide();
    }
  }

  /** Where the end of a handle is in the window, in CSS pixels. */
  handleAt(axis: "x" | "y" | "z"): { x: number; y: number } {
    return this.inWindow(this.gizmo.tip(axis));
  }

  /** Where the centre of what is drawn of a model or a link is in the window. */
  entityAt(name: string): { x: number; y: number } | undefined {
    const centre = this.stage.centreOf(name);
    return centre && this.inWindow(centre);
  }

  dispose(): void {
    this.listeners.abort();
    this.stage.showGhost(undefined);
    this.gizmo.dispose();
  }

  private down(event: PointerEvent): void {
    if (event.button !== 0) {
      return;
    }
    const { x, y } = this.at(event);
    const { stage } = this;
    stage.viewport.canvas.focus({ preventScroll: true });
    this.pressed = { x, y };
    const mode = this.mode.value;
    const drag = mode === "look" || mode === "insert" ? undefined : this.findTarget(mode, x, y);
    stage.viewport.view.leftButton = drag === undefined;
    if (drag) {
      this.drag = drag;
      stage.viewport.canvas.setPointerCapture(event.pointerId);
      stage.select(drag.name);
      stage.startDrag(drag.name);
    }
  }

  private findTarget(mode: Motion, x: number, y: number): Drag | undefined {
    const selected = this.stage.selected.value;
    const usesGizmo = selected !== "" && this.gizmo.press(x, y);
    const hit = usesGizmo ? undefined : this.stage.pick(x, y);
    const name = usesGizmo ? selected : hit?.name;
    const pose = name === undefined ? undefined : this.stage.poseOf(name);
    if (name === undefined || !pose) {
      return undefined;
    }
    if (!usesGizmo) {
      this.stage.select(name);
      this.gizmo.place(mode, pose, this.stage.radius);
    }
    const from = hit?.point ?? new Vector3();
    return { name, mode, usesGizmo, from, x, y, pose, motion: new Matrix4(), factors: new Vector3(1, 1, 1) };
  }

  private move(event: PointerEvent): void {
    const { drag, stage } = this;
    const { x, y } = this.at(event);
    if (!drag) {
      this.hover(x, y, event.buttons !== 0);
      return;
    }
    const snaps = event.ctrlKey || event.metaKey;
    if (drag.usesGizmo) {
      this.gizmo.drag(x, y, snaps);
    }
    switch (drag.mode) {
      case "move":
        drag.motion = drag.usesGizmo ? this.gizmo.motion : this.shift(drag, x, y, event.shiftKey, snaps);
        break;
      case "turn":
        drag.motion = drag.usesGizmo
          ? this.gizmo.motion
          : rotationAbout(drag.pose, round((x - drag.x) * ROTATION_PER_PX, snaps && SNAP.turn));
        break;
      case "scale": {
        const all = round(Math.exp((drag.y - y) * SCALE_PER_PX), snaps && SNAP.scale);
        drag.factors = this.allowed(drag.name, drag.usesGizmo ? this.gizmo.factors : new Vector3(all, all, all));
        drag.motion = stage.growth(drag.name, drag.factors);
      }
    }
    stage.preview(drag.name, drag.motion);
    this.sendPose(drag);
  }

  private hover(x: number, y: number, isPressed: boolean): void {
    if (isPressed) {
      return;
    }
    const { canvas } = this.stage.viewport;
    if (this.mode.value === "insert") {
      this.stage.showGhost(this.ghost(), this.placeAt(x, y));
    } else if (this.mode.value !== "look") {
      const isOver = this.gizmo.hover(x, y) || this.stage.pick(x, y) !== undefined;
      canvas.style.cursor = isOver ? "move" : "";
    }
  }

  /** Return the translation along the ground, or along the vertical. */
  private shift({ from, y: y0, pose }: Drag, x: number, y: number, isUpright: boolean, snaps: boolean): Matrix4 {
    const { viewport } = this.stage;
    const by = new Vector3();
    const at = isUpright ? undefined : viewport.planeAt(x, y, from.z);
    if (isUpright) {
      by.z = (y0 - y) * viewport.view.metresPerPixel(from, viewport.height);
    } else if (at) {
      by.set(at.x - from.x, at.y - from.y, 0);
    }
    const { position: p } = pose;
    const step = snaps && SNAP.move;
    return new Matrix4().makeTranslation(
      by.x && round(p.x + by.x, step) - p.x,
      by.y && round(p.y + by.y, step) - p.y,
      by.z && round(p.z + by.z, step) - p.z,
    );
  }

  /** Restrict scale factors: round shapes stay round, models of several links keep their proportions. */
  private allowed(name: string, { x, y, z }: Vector3): Vector3 {
    const { types, links } = this.stage.anatomy(name);
    const positive = (factor: number) => Math.max(MIN_FACTOR, factor);
    if (links === 1 && types.every((type) => type === Marker.CUBE)) {
      return new Vector3(positive(x), positive(y), positive(z));
    }
    if (links === 1 && types.every((type) => type === Marker.CUBE || type === Marker.CYLINDER)) {
      const wide = positive(farthest(x, y));
      return new Vector3(wide, wide, positive(z));
    }
    return new Vector3().setScalar(positive(farthest(x, y, z)));
  }

  private up(event: PointerEvent): void {
    const { pressed, drag } = this;
    this.endDrag();
    const { x, y } = this.at(event);
    const isClick = pressed && Math.hypot(x - pressed.x, y - pressed.y) < CLICK_PX;
    if (drag && !isClick) {
      void this.finish(drag);
    } else if (drag) {
      this.stage.release(drag.name);
    } else if (isClick && event.button === 0) {
      this.click(x, y, event.shiftKey);
    }
  }

  private endDrag(): void {
    this.gizmo.release();
    this.stage.viewport.view.leftButton = true;
    [this.drag, this.pressed] = [undefined, undefined];
  }

  /** Cancel the drag: the model returns to where it was. */
  private cancel(): void {
    const { drag } = this;
    this.endDrag();
    if (drag) {
      this.stage.release(drag.name);
      if (drag.mode !== "scale") {
        void this.run(() => this.simulator.move(drag.name, drag.pose));
      }
    }
  }

  private click(x: number, y: number, keepsMode: boolean): void {
    if (this.mode.value !== "insert") {
      this.stage.select(this.stage.pick(x, y)?.name ?? "");
      return;
    }
    const point = this.placeAt(x, y);
    if (point) {
      void this.insert(point, keepsMode);
    }
  }

  private async insert(point: Vector3, keepsMode: boolean): Promise<void> {
    const template = this.template.value;
    const color = this.color;
    let name = "";
    if (!keepsMode) {
      this.setMode("look");
    }
    this.stage.showGhost(undefined);
    await this.run(async () => {
      name =
        typeof template === "string"
          ? await this.simulator.insert(template, point, this.size.value, this.mass.value, color)
          : await this.simulator.spawn(template, point);
    });
    if (name) {
      this.inserted++;
      this.undoStack.push(name, "insert", () => this.simulator.remove(name));
      this.stage.select(name);
    }
  }

  /** Send the dragged model's pose to the simulator, as fast as it responds. */
  private sendPose(drag: Drag): void {
    if (this.sending || drag.mode === "scale") {
      return;
    }
    this.sending = this.simulator
      .move(drag.name, movedPose(drag.pose, drag.motion))
      .catch((error: unknown) => {
        this.error.value = error instanceof Error ? error.message : String(error);
      })
      .finally(() => {
        this.sending = undefined;
      });
  }

  private async finish({ name, mode, pose, motion, factors }: Drag): Promise<void> {
    const isDone = await this.run(async () => {
      if (mode === "scale") {
        await this.simulator.scale(name, factors);
      } else {
        await this.simulator.move(name, movedPose(pose, motion));
      }
      this.stage.release(name);
    });
    this.stage.release(name);
    if (isDone) {
      const back = new Vector3(1 / factors.x, 1 / factors.y, 1 / factors.z);
      const undo = () => (mode === "scale" ? this.simulator.scale(name, back) : this.simulator.move(name, pose));
      this.undoStack.push(name, mode, undo);
    }
  }

  private async restore(name: string): Promise<void> {
    await this.simulator.bringBack(name);
    this.stage.show(await this.simulator.look());
    this.stage.select(name);
  }

  private focusOn(event: MouseEvent): void {
    const { x, y } = this.at(event);
    const hit = this.stage.pick(x, y);
    if (hit && this.mode.value !== "insert") {
      this.stage.viewport.view.lookAt(hit.point);
    }
  }

  private key(event: KeyboardEvent): void {
    if (this.isForOtherPanel(event.target)) {
      return;
    }
    const { key, ctrlKey, metaKey, altKey } = event;
    const mode = KEYS[key];
    if ((ctrlKey || metaKey) && key === "z") {
      this.undo();
    } else if (ctrlKey || metaKey || altKey) {
      return;
    } else if (key === "Delete" || key === "Backspace") {
      void this.remove();
    } else if (mode) {
      this.setMode(mode);
    } else if (key === "Escape") {
      this.escape();
    } else {
      return;
    }
    event.preventDefault();
    event.stopPropagation();
  }

  private escape(): void {
    if (this.drag) {
      this.cancel();
    } else if (this.mode.value !== "look") {
      this.setMode("look");
    } else {
      this.stage.select("");
    }
  }

  /** Whether a key is for another panel: the editor takes it with the focus, or without any focus if there is no 3-D panel. */
  private isForOtherPanel(target: EventTarget | null): boolean {
    if (target === document.body) {
      return document.querySelector("[data-panel=scene]") !== null;
    }
    const panel = this.container.closest("[data-panel]");
    return (
      !(target instanceof HTMLElement) ||
      !panel?.contains(target) ||
      target.matches("input:not([type=checkbox]), textarea, select")
    );
  }

  private inWindow(point: Vector3): { x: number; y: number } {
    const { viewport } = this.stage;
    const [at, box] = [viewport.project(point), viewport.canvas.getBoundingClientRect()];
    return { x: box.left + at.x, y: box.top + at.y };
  }

  /** The point under a pixel at which a model is inserted. */
  private placeAt(x: number, y: number): Vector3 | undefined {
    return this.stage.pick(x, y)?.point ?? this.stage.viewport.groundAt(x, y);
  }

  private ghost(): Marker {
    const template = this.template.value;
    const size = typeof template === "string" ? this.size.value : UNKNOWN_SIZE_M;
    return {
      ns: "",
      id: 0,
      type: typeof template === "string" ? MARKERS[template] : Marker.CUBE,
      pose: { position: { x: 0, y: 0, z: size / 2 }, orientation: { x: 0, y: 0, z: 0, w: 1 } },
      scale: { x: size, y: size, z: size },
      color: this.color,
    } as Marker;
  }

  private at(event: MouseEvent): { x: number; y: number } {
    const box = this.stage.viewport.canvas.getBoundingClientRect();
    return { x: event.clientX - box.left, y: event.clientY - box.top };
  }

  private get color(): ColorRGBA {
    const hex = PALETTE[this.inserted % PALETTE.length] as string;
    const part = (from: number) => parseInt(hex.slice(from, from + 2), 16) / 255;
    return { r: part(1), g: part(3), b: part(5), a: 1 };
  }
}

/** A rotation about the vertical through a pose's origin. */
function rotationAbout({ position: { x, y, z } }: Pose, angle: number): Matrix4 {
  return new Matrix4()
    .makeTranslation(x, y, z)
    .multiply(new Matrix4().makeRotationZ(angle))
    .multiply(new Matrix4().makeTranslation(-x, -y, -z));
}

function round(value: number, step: number | false): number {
  return step ? Math.round(value / step) * step : value;
}

/** The factor that differs most from 1. */
function farthest(...factors: number[]): number {
  const change = (factor: number) => Math.abs(Math.log(Math.max(MIN_FACTOR, factor)));
  return factors.reduce((extreme, factor) => (change(factor) > change(extreme) ? factor : extreme));
}

/** A model's pose as text: metres, and degrees about the vertical. */
export function describePose({ position: { x, y, z }, orientation: o }: Pose): string {
  const yaw = new Euler().setFromQuaternion(new Quaternion(o.x, o.y, o.z, o.w), "ZYX").z;
  const metres = [x, y, z].map((each, i) => `${"xyz"[i]} ${tidy(each.toFixed(2))}`).join("  ");
  return `${metres} m  yaw ${tidy(((yaw * 180) / Math.PI).toFixed(0))}°`;
}

function tidy(number: string): string {
  return Number(number) === 0 ? number.replace("-", "") : number;
}
