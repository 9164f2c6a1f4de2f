// The tools of the 3-D view: the selected one receives the mouse.
import { signal } from "@preact/signals";
import type { Viewport } from "../scene/viewport";
import { MOVE_CAMERA, TOOLS } from "./registry";
import type { Pointer, Tool, ToolContext, ToolType } from "./tool";

export class Toolbox {
  readonly active = signal<ToolType>(MOVE_CAMERA);
  /** The tools that have been selected so far. */
  readonly used = signal<ReadonlySet<string>>(new Set());
  /** The selected tool's message. */
  readonly message = signal("");
  private tool: Tool | undefined;
  private pressed = false;
  private readonly listening = new AbortController();

  constructor(
    private readonly viewport: Viewport,
    private readonly context: Omit<ToolContext, "showMessage" | "finish">,
  ) {
    const { signal: until } = this.listening;
    const { canvas } = viewport;
    canvas.addEventListener("pointerdown", (event) => this.down(event), { signal: until });
    canvas.addEventListener("pointermove", (event) => this.move(event), { signal: until });
    canvas.addEventListener("pointerup", (event) => this.up(event), { signal: until });
    canvas.addEventListener("pointercancel", () => (this.pressed = false), { signal: until });
    canvas.addEventListener("contextmenu", (event) => event.preventDefault(), { signal: until });
  }

  select(type: ToolType): void {
    this.tool?.dispose();
    this.tool = type.create?.({
      ...this.context,
      showMessage: (text) => (this.message.value = text),
      finish: () => this.select(MOVE_CAMERA),
    });
    this.pressed = false;
    this.used.value = new Set(this.used.peek()).add(this.active.peek().id);
    this.active.value = type;
    this.message.value = "";
    this.viewport.view.leftButton = this.tool === undefined;
    this.viewport.canvas.style.cursor = this.tool ? "crosshair" : "";
    this.viewport.invalidate();
  }

  selectById(id: string): void {
    const type = TOOLS.find((each) => each.id === id);
    if (type) {
      this.select(type);
    }
  }

  /** Select the tool of a key; false where there is none. */
  selectByKey(key: string): boolean {
    const type = key === "Escape" ? MOVE_CAMERA : TOOLS.find((each) => each.key === key);
    if (type) {
      this.select(type);
    }
    return type !== undefined;
  }

  dispose(): void {
    this.tool?.dispose();
    this.listening.abort();
  }

  private down(event: PointerEvent): void {
    this.viewport.canvas.focus({ preventScroll: true });
    if (this.tool && event.button === 0) {
      this.viewport.canvas.setPointerCapture(event.pointerId);
      this.pressed = true;
      this.tool.pressed?.(this.pointer(event));
    }
  }

  private move(event: PointerEvent): void {
    this.tool?.moved?.(this.pointer(event), this.pressed);
  }

  private up(event: PointerEvent): void {
    if (this.tool && event.button === 0 && this.pressed) {
      this.pressed = false;
      this.tool.released?.(this.pointer(event));
    }
  }

  private pointer(event: PointerEvent): Pointer {
    const box = this.viewport.canvas.getBoundingClientRect();
    const [x, y] = [event.clientX - box.left, event.clientY - box.top];
    return { x, y, ground: this.viewport.groundAt(x, y), surface: () => this.viewport.surfaceAt(x, y) };
  }
}
