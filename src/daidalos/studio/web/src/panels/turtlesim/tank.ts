// The square that turtles live in: their drawing, and above it the turtles, swimming.
import { Paper, pixelsPerUnit, PIXELS } from "./paper";
import { drawShadow, drawTurtle, HALF_SHELL } from "./turtle_art";
import type { TurtleSprite, TurtleWindow } from "../../generated/daidalos_msgs";

const LARGEST_PX = 2400;
/** Distance in units, and angle in radians, of one stroke of a turtle's flippers. */
const STROKE_UNITS = 0.55;
const STROKE_RADIANS = 0.9;
const REACH = 0.5;
const SHADOW_SHIFT_PX = 3.2;

/** How a turtle swims: where it was, and where its flippers are. */
interface Gait {
  x: number;
  y: number;
  theta: number;
  phase: number;
  /** Amplitude of the flippers: 1 in full motion, 0 at rest. */
  vigour: number;
  /** Turning to the left, 1 to -1. */
  turning: number;
}

export class Tank {
  readonly paper: Paper;
  /** Whose name is shown although it is alone. */
  hovered = "";
  private readonly context: CanvasRenderingContext2D;
  private readonly gaits = new Map<string, Gait>();
  private shown: TurtleWindow | undefined;
  private isDirty = true;
  private drawnAt = 0;

  constructor(
    drawing: HTMLCanvasElement,
    private readonly canvas: HTMLCanvasElement,
  ) {
    this.paper = new Paper(drawing);
    this.context = canvas.getContext("2d") as CanvasRenderingContext2D;
  }

  /** Fit this many CSS pixels; returns whether that is another size. */
  resize(cssPixels: number): boolean {
    const size = Math.max(1, Math.min(LARGEST_PX, Math.round(cssPixels * devicePixelRatio)));
    if (size === this.canvas.width) {
      return false;
    }
    this.paper.resize(size);
    this.canvas.width = this.canvas.height = size;
    this.isDirty = true;
    return true;
  }

  show(message: TurtleWindow): void {
    this.shown = message;
    this.paper.width = message.width;
    this.isDirty = true;
  }

  /** Draw a frame, where something changed; `page` is the page's clock in seconds. */
  frame(page: number): void {
    const since = Math.min(0.1, page - this.drawnAt);
    if (!this.isDirty || !this.shown) {
      return;
    }
    this.drawnAt = page;
    this.isDirty = false;
    const { context, shown } = this;
    const scale = this.canvas.width / PIXELS;
    context.resetTransform();
    context.clearRect(0, 0, this.canvas.width, this.canvas.height);
    for (const turtle of shown.turtles) {
      this.place(turtle, scale, SHADOW_SHIFT_PX);
      drawShadow(context);
    }
    for (const turtle of shown.turtles) {
      const gait = this.swim(turtle, since);
      this.place(turtle, scale);
      drawTurtle(context, turtle.kind, flippers(gait));
    }
    this.forgetOthers(shown.turtles);
    const isCrowd = shown.turtles.length > 1;
    for (const turtle of shown.turtles) {
      if (isCrowd || turtle.name === this.hovered) {
        this.label(turtle, scale);
      }
    }
  }

  /** The turtle at a place, given in shares of the window from its upper left. */
  turtleAt(across: number, down: number): TurtleSprite | undefined {
    const { x, y } = { x: across * PIXELS, y: down * PIXELS };
    return this.shown?.turtles.findLast((turtle) => {
      const at = this.position(turtle);
      return Math.hypot(at.x - x, at.y - y) < 1.5 * HALF_SHELL;
    });
  }

  redraw(): void {
    this.isDirty = true;
  }

  private position({ x, y }: TurtleSprite): { x: number; y: number } {
    const unit = pixelsPerUnit(this.paper.width);
    return { x: x * unit + 0.5, y: PIXELS - 0.5 - y * unit };
  }

  private place(turtle: TurtleSprite, scale: number, down = 0): void {
    const { x, y } = this.position(turtle);
    this.context.setTransform(scale, 0, 0, scale, x * scale, (y + down) * scale);
    this.context.rotate(-turtle.theta);
    this.context.scale(HALF_SHELL, HALF_SHELL);
  }

  private swim(turtle: TurtleSprite, since: number): Gait {
    const { x, y, theta } = turtle;
    const gait = this.gaits.get(turtle.name) ?? { x, y, theta, phase: 0, vigour: 0, turning: 0 };
    this.gaits.set(turtle.name, gait);
    const turned = Math.atan2(Math.sin(theta - gait.theta), Math.cos(theta - gait.theta));
    const strokes = Math.hypot(x - gait.x, y - gait.y) / STROKE_UNITS + Math.abs(turned) / STROKE_RADIANS;
    const isMoving = strokes > 1e-4 && strokes < 2; // more than that is a teleport
    const ease = 1 - Math.exp(-since / 0.12);
    gait.vigour += ease * ((isMoving ? 1 : 0) - gait.vigour);
    gait.turning += ease * ((isMoving ? clamp(turned / STROKE_RADIANS / strokes) : 0) - gait.turning);
    gait.phase += isMoving ? 2 * Math.PI * strokes : 0;
    Object.assign(gait, { x, y, theta });
    if (gait.vigour > 0.01) {
      this.isDirty = true; // until its flippers are at rest
    }
    return gait;
  }

  private forgetOthers(turtles: readonly TurtleSprite[]): void {
    const present = new Set(turtles.map(({ name }) => name));
    for (const name of this.gaits.keys()) {
      if (!present.has(name)) {
        this.gaits.delete(name);
      }
    }
  }

  private label(turtle: TurtleSprite, scale: number): void {
    const { context } = this;
    const { x, y } = this.position(turtle);
    context.setTransform(scale, 0, 0, scale, 0, 0);
    context.font = "500 9.5px system-ui, sans-serif";
    const width = context.measureText(turtle.name).width + 10;
    const left = Math.min(Math.max(x - width / 2, 2), PIXELS - width - 2);
    const top = y > 50 ? y - 42 : y + 28;
    context.beginPath();
    context.roundRect(left, top, width, 14, 7);
    context.fillStyle = "#0a1020a6";
    context.fill();
    context.fillStyle = "#f3f6fb";
    context.textBaseline = "middle";
    context.textAlign = "center";
    context.fillText(turtle.name, left + width / 2, top + 7.4);
  }
}

/** Both beat together when it swims ahead; against each other when it turns on the spot. */
function flippers({ phase, vigour, turning }: Gait): { left: number; right: number } {
  const ahead = Math.sin(phase) * (1 - Math.abs(turning));
  const round = Math.sin(phase) * turning;
  return { left: REACH * vigour * (ahead - round), right: REACH * vigour * (ahead + round) };
}

function clamp(value: number): number {
  return Math.min(1, Math.max(-1, value));
}
