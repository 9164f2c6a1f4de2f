// A drawing that is moved with the mouse and zoomed with the wheel or two fingers.
const MIN_SCALE = 0.15;
const MAX_SCALE = 3;
/** A drawing that fits is not blown up beyond this. */
const MAX_FITTED_SCALE = 1.25;
const CLICK_PX = 4;

export class Canvas {
  /** Whether the user has moved the drawing. */
  isMoved = false;
  private x = 0;
  private y = 0;
  private scale = 1;
  private readonly fingers = new Map<number, { x: number; y: number }>();
  private travelled = 0;
  private readonly listening = new AbortController();

  constructor(
    private readonly frame: SVGSVGElement,
    private readonly content: SVGGElement,
  ) {
    const { signal } = this.listening;
    frame.addEventListener("wheel", (event) => this.wheel(event), { signal, passive: false });
    frame.addEventListener("pointerdown", (event) => this.down(event), { signal });
    frame.addEventListener("pointermove", (event) => this.move(event), { signal });
    for (const end of ["pointerup", "pointercancel"] as const) {
      frame.addEventListener(end, (event) => this.fingers.delete(event.pointerId), { signal });
    }
  }

  /** Whether the last press was a click, not a way to move the drawing. */
  get wasClick(): boolean {
    return this.travelled < CLICK_PX;
  }

  fit(width: number, height: number): void {
    const { clientWidth, clientHeight } = this.frame;
    this.scale = Math.min(MAX_FITTED_SCALE, clientWidth / width, clientHeight / height) || 1;
    this.x = (clientWidth - this.scale * width) / 2;
    this.y = (clientHeight - this.scale * height) / 2;
    this.isMoved = false;
    this.apply();
  }

  /** Zoom around the middle. */
  zoom(factor: number): void {
    this.zoomAt(this.frame.clientWidth / 2, this.frame.clientHeight / 2, factor);
  }

  dispose(): void {
    this.listening.abort();
  }

  private zoomAt(x: number, y: number, factor: number): void {
    const scale = Math.min(MAX_SCALE, Math.max(MIN_SCALE, this.scale * factor));
    this.x = x - ((x - this.x) * scale) / this.scale;
    this.y = y - ((y - this.y) * scale) / this.scale;
    this.scale = scale;
    this.isMoved = true;
    this.apply();
  }

  private wheel(event: WheelEvent): void {
    event.preventDefault();
    const box = this.frame.getBoundingClientRect();
    this.zoomAt(event.clientX - box.left, event.clientY - box.top, Math.exp(-event.deltaY * 0.0015));
  }

  private down({ pointerId, clientX: x, clientY: y }: PointerEvent): void {
    if (this.fingers.size === 0) {
      this.travelled = 0;
    }
    this.fingers.set(pointerId, { x, y });
  }

  private move({ pointerId, clientX: x, clientY: y }: PointerEvent): void {
    const before = this.fingers.get(pointerId);
    if (!before) {
      return;
    }
    const other = [...this.fingers].find(([id]) => id !== pointerId)?.[1];
    this.fingers.set(pointerId, { x, y });
    this.travelled += Math.hypot(x - before.x, y - before.y);
    if (other) {
      const box = this.frame.getBoundingClientRect();
      const grown = Math.hypot(x - other.x, y - other.y) / Math.hypot(before.x - other.x, before.y - other.y);
      this.zoomAt((x + other.x) / 2 - box.left, (y + other.y) / 2 - box.top, grown || 1);
    } else if (!this.wasClick) {
      this.frame.setPointerCapture(pointerId);
      this.x += x - before.x;
      this.y += y - before.y;
      this.isMoved = true;
      this.apply();
    }
  }

  private apply(): void {
    this.content.setAttribute("transform", `translate(${this.x} ${this.y}) scale(${this.scale})`);
  }
}
