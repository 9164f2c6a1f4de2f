// What the mouse and the keys do with the simulated world: look around, take hold of models, put new ones.
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
const TURN_PER_PX = 0.012;
const GROW_PER_PX = 0.007;
const MIN_FACTOR = 0.02;
/** How large what stands for a model is that has not been put yet. */
const UNKNOWN_SIZE_M = 0.4;
/** Colours of what is inserted, one after the other. */
const PALETTE = ["#e2a355", "#4d8dff", "#5fc26b", "#f2555a", "#a78bfa", "#3fc1c9"];
const MARKERS: Record<Shape, number> = {
  box: Marker.CUBE,
  sphere: Marker.SPHERE,
  cylinder: Marker.CYLINDER,
};
/** Gazebo's keys, without Ctrl. */
const KEYS: Readonly<Record<string, Mode>> = { t: "move", r: "turn", s: "scale" };

interface Hold {
  name: string;
  mode: Motion;
  /** Taken by a handle, else by the model itself. */
  byHandle: boolean;
  from: Vector3;
  x: number;
  y: number;
  pose: Pose;
  motion: Matrix4;
  factors: Vector3;
}

export class Editor {
  readonly mode = signal<Mode>("look");
  /** What is to be put next. */
  readonly goods = signal<Shape | Resource>("box");
  readonly size = signal(0.3);
  readonly mass = signal(1);
  readonly error = signal("");
  readonly undoStack = new UndoStack();
  private readonly gizmo: Gizmo;
  private hold: Hold | undefined;
  private pressed: { x: number; y: number } | undefined;
  private inserted = 0;
  /** The last move of the hand, until the simulator has answered. */
  private telling: Promise<void> | undefined;
  private doing = 0;
  private readonly listening = new AbortController();

  constructor(
    private readonly container: HTMLElement,
    private readonly stage: Stage,
    private readonly simulator: Simulator,
  ) {
    this.gizmo = new Gizmo(stage.viewport);
    const { signal } = this.listening;
    // Before the camera hears of it: whoever has hold of a model does not turn the view.
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

  take(mode: Mode, goods: Shape | Resource = this.goods.value): void {
    this.cancel();
    this.mode.value = mode;
    this.goods.value = goods;
    this.stage.showGhost(undefined);
    this.stage.viewport.canvas.style.cursor = mode === "insert" ? "crosshair" : "";
  }

  /** Take what is selected out of the world. */
  async remove(): Promise<void> {
    const name = this.stage.selected.value;
    if (name && (await this.do(() => this.simulator.remove(name)))) {
      this.undoStack.push(name, "delete", () => this.bringBack(name));
    }
  }

  /** Take back what was done last: what was put goes, what was deleted comes back, all else is as before. */
  undo(): void {
    const last = this.undoStack.pop();
    if (last) {
      void this.do(last.undo);
    }
  }

  /** Whether the simulator has still to answer. */
  get isBusy(): boolean {
    return this.doing > 0 || this.telling !== undefined;
  }

  /** Do something with the simulator, say what went wrong, and look again. */
  async do(work: () => Promise<unknown>): Promise<boolean> {
    this.error.value = "";
    this.doing++;
    try {
      await this.telling; // answers may overtake each other: the last word is to be the last
      await work();
      this.stage.show(await this.simulator.look());
      return true;
    } catch (error) {
      this.error.value = error instanceof Error ? error.message : String(error);
      return false;
    } finally {
      this.doing--;
    }
  }

  /** Keep the handles at the selected model; once per frame. */
  follow(): void {
    if (this.hold) {
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

  /** Where a model is in the window. */
  modelAt(name: string): { x: number; y: number } | undefined {
    const position = this.stage.poseOf(name)?.position;
    return position && this.inWindow(new Vector3(position.x, position.y, position.z));
  }

  dispose(): void {
    this.listening.abort();
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
    const hold = mode === "look" || mode === "insert" ? undefined : this.grasp(mode, x, y);
    stage.viewport.view.leftButton = hold === undefined;
    if (hold) {
      this.hold = hold;
      stage.viewport.canvas.setPointerCapture(event.pointerId);
      stage.select(hold.name);
      stage.hold(hold.name);
    }
  }

  private grasp(mode: Motion, x: number, y: number): Hold | undefined {
    const selected = this.stage.selected.value;
    const byHandle = selected !== "" && this.gizmo.press(x, y);
    const hit = byHandle ? undefined : this.stage.pick(x, y);
    const name = byHandle ? selected : hit?.name;
    const pose = name === undefined ? undefined : this.stage.poseOf(name);
    if (name === undefined || !pose) {
      return undefined;
    }
    if (!byHandle) {
      this.stage.select(name);
      this.gizmo.place(mode, pose, this.stage.radius);
    }
    const from = hit?.point ?? new Vector3();
    return { name, mode, byHandle, from, x, y, pose, motion: new Matrix4(), factors: new Vector3(1, 1, 1) };
  }

  private move(event: PointerEvent): void {
    const { hold, stage } = this;
    const { x, y } = this.at(event);
    if (!hold) {
      this.hover(x, y, event.buttons !== 0);
      return;
    }
    const snaps = event.ctrlKey || event.metaKey;
    if (hold.byHandle) {
      this.gizmo.drag(x, y, snaps);
    }
    switch (hold.mode) {
      case "move":
        hold.motion = hold.byHandle ? this.gizmo.motion : this.shift(hold, x, y, event.shiftKey, snaps);
        break;
      case "turn":
        hold.motion = hold.byHandle
          ? this.gizmo.motion
          : turnAbout(hold.pose, round((x - hold.x) * TURN_PER_PX, snaps && SNAP.turn));
        break;
      case "scale": {
        const all = round(Math.exp((hold.y - y) * GROW_PER_PX), snaps && SNAP.scale);
        hold.factors = this.allowed(hold.name, hold.byHandle ? this.gizmo.factors : new Vector3(all, all, all));
        hold.motion = stage.growth(hold.name, hold.factors);
      }
    }
    stage.preview(hold.name, hold.motion);
    this.tell(hold);
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

  /** Move along the ground, or up and down. */
  private shift({ from, y: y0, pose }: Hold, x: number, y: number, isUpright: boolean, snaps: boolean): Matrix4 {
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

  /** Factors that a model can take: what is round stays round, what has several parts keeps its proportions. */
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
    const { pressed, hold } = this;
    this.letGo();
    const { x, y } = this.at(event);
    const isClick = pressed && Math.hypot(x - pressed.x, y - pressed.y) < CLICK_PX;
    if (hold && !isClick) {
      void this.finish(hold);
    } else if (hold) {
      this.stage.release(hold.name);
    } else if (isClick && event.button === 0) {
      this.click(x, y, event.shiftKey);
    }
  }

  private letGo(): void {
    this.gizmo.release();
    this.stage.viewport.view.leftButton = true;
    [this.hold, this.pressed] = [undefined, undefined];
  }

  /** Let go of a model as if it had never been taken hold of. */
  private cancel(): void {
    const { hold } = this;
    this.letGo();
    if (hold) {
      this.stage.release(hold.name);
      if (hold.mode !== "scale") {
        void this.do(() => this.simulator.move(hold.name, hold.pose));
      }
    }
  }

  private click(x: number, y: number, goesOn: boolean): void {
    if (this.mode.value !== "insert") {
      this.stage.select(this.stage.pick(x, y)?.name ?? "");
      return;
    }
    const point = this.placeAt(x, y);
    if (point) {
      void this.insert(point, goesOn);
    }
  }

  private async insert(point: Vector3, goesOn: boolean): Promise<void> {
    const goods = this.goods.value;
    const color = this.color;
    let name = "";
    if (!goesOn) {
      this.take("look");
    }
    this.stage.showGhost(undefined);
    await this.do(async () => {
      name =
        typeof goods === "string"
          ? await this.simulator.insert(goods, point, this.size.value, this.mass.value, color)
          : await this.simulator.spawn(goods, point);
    });
    if (name) {
      this.inserted++;
      this.undoStack.push(name, "insert", () => this.simulator.remove(name));
      this.stage.select(name);
    }
  }

  /** Let the model follow the hand in the simulation too, as fast as that answers. */
  private tell(hold: Hold): void {
    if (this.telling || hold.mode === "scale") {
      return;
    }
    this.telling = this.simulator
      .move(hold.name, movedPose(hold.pose, hold.motion))
      .catch((error: unknown) => {
        this.error.value = error instanceof Error ? error.message : String(error);
      })
      .finally(() => {
        this.telling = undefined;
      });
  }

  private async finish({ name, mode, pose, motion, factors }: Hold): Promise<void> {
    const isDone = await this.do(async () => {
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

  private async bringBack(name: string): Promise<void> {
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
    if (this.isForOthers(event.target)) {
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
      this.take(mode);
    } else if (key === "Escape") {
      this.escape();
    } else {
      return;
    }
    event.preventDefault();
    event.stopPropagation();
  }

  private escape(): void {
    if (this.hold) {
      this.cancel();
    } else if (this.mode.value !== "look") {
      this.take("look");
    } else {
      this.stage.select("");
    }
  }

  /** Keys are the editor's where it has the focus, or where nobody has it and no other view is there. */
  private isForOthers(target: EventTarget | null): boolean {
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

  /** Where something that is put at a pixel stands: on what is there. */
  private placeAt(x: number, y: number): Vector3 | undefined {
    return this.stage.pick(x, y)?.point ?? this.stage.viewport.groundAt(x, y);
  }

  private ghost(): Marker {
    const goods = this.goods.value;
    const size = typeof goods === "string" ? this.size.value : UNKNOWN_SIZE_M;
    return {
      ns: "",
      id: 0,
      type: typeof goods === "string" ? MARKERS[goods] : Marker.CUBE,
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

/** Turn in the world about the vertical through a pose's origin. */
function turnAbout({ position: { x, y, z } }: Pose, angle: number): Matrix4 {
  return new Matrix4()
    .makeTranslation(x, y, z)
    .multiply(new Matrix4().makeRotationZ(angle))
    .multiply(new Matrix4().makeTranslation(-x, -y, -z));
}

function round(value: number, step: number | false): number {
  return step ? Math.round(value / step) * step : value;
}

/** The factor that is farthest from leaving things as they are. */
function farthest(...factors: number[]): number {
  const change = (factor: number) => Math.abs(Math.log(Math.max(MIN_FACTOR, factor)));
  return factors.reduce((most, factor) => (change(factor) > change(most) ? factor : most));
}

/** A model's place in words: metres, and degrees about the vertical. */
export function describePose({ position: { x, y, z }, orientation: o }: Pose): string {
  const yaw = new Euler().setFromQuaternion(new Quaternion(o.x, o.y, o.z, o.w), "ZYX").z;
  const metres = [x, y, z].map((each, i) => `${"xyz"[i]} ${tidy(each.toFixed(2))}`).join("  ");
  return `${metres} m  yaw ${tidy(((yaw * 180) / Math.PI).toFixed(0))}°`;
}

function tidy(number: string): string {
  return Number(number) === 0 ? number.replace("-", "") : number;
}
