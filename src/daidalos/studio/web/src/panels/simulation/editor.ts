// What the mouse does with the simulated world: look around, take hold of models, put new ones.
import { signal } from "@preact/signals";
import { Vector3 } from "three";
import type { ColorRGBA } from "../../ros/messages";
import { movedPose, type Stage } from "./stage";
import type { Resource, Simulator } from "./simulator";

export type Mode = "look" | "move" | "turn" | "scale" | "insert";
export type Shape = "box" | "sphere" | "cylinder";

const CLICK_PX = 4;
const TURN_PER_PX = 0.012;
const GROW_PER_PX = 0.007;
/** Colours of what is inserted, one after the other. */
const PALETTE = ["#e2a355", "#4d8dff", "#5fc26b", "#f2555a", "#a78bfa", "#3fc1c9"];

interface Hold {
  name: string;
  mode: Mode;
  from: Vector3;
  x: number;
  y: number;
  by: Vector3;
  yaw: number;
  factor: number;
}

export class Editor {
  readonly mode = signal<Mode>("look");
  /** What is to be put next. */
  readonly goods = signal<Shape | Resource>("box");
  readonly size = signal(0.3);
  readonly mass = signal(1);
  readonly complaint = signal("");
  private hold: Hold | undefined;
  private pressed: { x: number; y: number } | undefined;
  private inserted = 0;
  private isTelling = false;
  private readonly listening = new AbortController();

  constructor(
    container: HTMLElement,
    private readonly stage: Stage,
    private readonly simulator: Simulator,
  ) {
    const { signal } = this.listening;
    // Before the camera hears of it: whoever has hold of a model does not turn the view.
    container.addEventListener("pointerdown", (event) => this.down(event), { signal, capture: true });
    container.addEventListener("pointermove", (event) => this.move(event), { signal });
    container.addEventListener("pointerup", (event) => this.up(event), { signal });
    container.addEventListener("pointercancel", () => this.letGo(), { signal });
    container.addEventListener("keydown", (event) => this.key(event), { signal });
    container.addEventListener("contextmenu", (event) => event.preventDefault(), { signal });
  }

  take(mode: Mode, goods: Shape | Resource = this.goods.value): void {
    this.mode.value = mode;
    this.goods.value = goods;
    this.stage.viewport.canvas.style.cursor = mode === "look" ? "" : mode === "insert" ? "crosshair" : "move";
  }

  /** Take what is selected out of the world. */
  remove(): void {
    const name = this.stage.selected.value;
    if (name) {
      void this.do(() => this.simulator.remove(name));
    }
  }

  /** Do something with the simulator, say what went wrong, and look again. */
  async do(work: () => Promise<unknown>): Promise<void> {
    this.complaint.value = "";
    try {
      await work();
      this.stage.show(await this.simulator.look());
    } catch (error) {
      this.complaint.value = error instanceof Error ? error.message : String(error);
    }
  }

  dispose(): void {
    this.listening.abort();
  }

  private down(event: PointerEvent): void {
    if (event.button !== 0) {
      return;
    }
    const { x, y } = this.at(event);
    this.stage.viewport.canvas.focus({ preventScroll: true });
    this.pressed = { x, y };
    const mode = this.mode.value;
    const hit = mode === "look" || mode === "insert" ? undefined : this.stage.pick(x, y);
    this.stage.viewport.view.leftButton = hit === undefined;
    if (hit) {
      this.stage.viewport.canvas.setPointerCapture(event.pointerId);
      this.stage.select(hit.name);
      this.stage.hold(hit.name);
      this.hold = { name: hit.name, mode, from: hit.point, x, y, by: new Vector3(), yaw: 0, factor: 1 };
    }
  }

  private move(event: PointerEvent): void {
    const { hold, stage } = this;
    if (!hold) {
      return;
    }
    const { x, y } = this.at(event);
    if (hold.mode === "turn") {
      hold.yaw = (x - hold.x) * TURN_PER_PX;
    } else if (hold.mode === "scale") {
      hold.factor = Math.exp((hold.y - y) * GROW_PER_PX);
    } else if (event.shiftKey) {
      hold.by.z = (hold.y - y) * stage.viewport.view.metresPerPixel(hold.from, stage.viewport.height);
    } else {
      const at = stage.viewport.planeAt(x, y, hold.from.z);
      if (at) {
        hold.by.set(at.x - hold.from.x, at.y - hold.from.y, hold.by.z);
      }
    }
    stage.preview(hold.name, hold.by, hold.yaw, hold.factor);
    void this.tell(hold);
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
      this.click(x, y);
    }
  }

  private letGo(): void {
    this.stage.viewport.view.leftButton = true;
    [this.hold, this.pressed] = [undefined, undefined];
  }

  private click(x: number, y: number): void {
    if (this.mode.value !== "insert") {
      this.stage.select(this.stage.pick(x, y)?.name ?? "");
      return;
    }
    const point = this.stage.pick(x, y)?.point ?? this.stage.viewport.groundAt(x, y);
    if (point) {
      void this.insert(point);
    }
  }

  private async insert(point: Vector3): Promise<void> {
    const goods = this.goods.value;
    let name = "";
    await this.do(async () => {
      name =
        typeof goods === "string"
          ? await this.simulator.insert(goods, point, this.size.value, this.mass.value, this.nextColor())
          : await this.simulator.spawn(goods, point);
    });
    this.stage.select(name);
  }

  /** Let the model follow the hand in the simulation too, as fast as that answers. */
  private async tell(hold: Hold): Promise<void> {
    const pose = this.stage.poseAtHold(hold.name);
    if (this.isTelling || !pose || hold.mode === "scale") {
      return;
    }
    this.isTelling = true;
    try {
      await this.simulator.move(hold.name, movedPose(pose, hold.by, hold.yaw));
    } catch (error) {
      this.complaint.value = error instanceof Error ? error.message : String(error);
    } finally {
      this.isTelling = false;
    }
  }

  private async finish(hold: Hold): Promise<void> {
    const pose = this.stage.poseAtHold(hold.name);
    await this.do(async () => {
      if (hold.mode === "scale") {
        await this.simulator.scale(hold.name, hold.factor);
      } else if (pose) {
        await this.simulator.move(hold.name, movedPose(pose, hold.by, hold.yaw));
      }
      this.stage.release(hold.name);
    });
    this.stage.release(hold.name);
  }

  private key(event: KeyboardEvent): void {
    if (event.key === "Delete" || event.key === "Backspace") {
      this.remove();
    } else if (event.key === "Escape") {
      this.take("look");
      this.stage.select("");
    } else {
      return;
    }
    event.preventDefault();
  }

  private at(event: PointerEvent): { x: number; y: number } {
    const box = this.stage.viewport.canvas.getBoundingClientRect();
    return { x: event.clientX - box.left, y: event.clientY - box.top };
  }

  private nextColor(): ColorRGBA {
    const hex = PALETTE[this.inserted++ % PALETTE.length] as string;
    const part = (from: number) => parseInt(hex.slice(from, from + 2), 16) / 255;
    return { r: part(1), g: part(3), b: part(5), a: 1 };
  }
}
