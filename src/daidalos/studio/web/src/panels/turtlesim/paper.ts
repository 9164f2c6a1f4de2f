// The canvas that turtles draw on: as fine as the screen, whatever its size.
import type { GetTurtleDrawing_Response } from "../../generated/daidalos_msgs";
import type { Lines, Sheet } from "./follower";

/** Width of turtlesim's own window in pixels, the unit of pen widths. */
export const PIXELS = 500;

/** From units of turtlesim to its pixels. */
export function pixelsPerUnit(width: number): number {
  return (PIXELS - 1) / width;
}

export class Paper implements Sheet {
  width = 499 / 45;
  private readonly context: CanvasRenderingContext2D;

  constructor(readonly canvas: HTMLCanvasElement) {
    this.context = canvas.getContext("2d") as CanvasRenderingContext2D;
  }

  wipe(): void {
    this.context.resetTransform();
    this.context.clearRect(0, 0, this.canvas.width, this.canvas.height);
  }

  draw({ lines, pens }: Lines): void {
    const { context } = this;
    this.scale();
    const unit = pixelsPerUnit(this.width);
    let pen = -1;
    let [endX, endY] = [NaN, NaN];
    for (let i = 0; i + 3 < lines.length; i += 4) {
      const packed = new DataView(pens.buffer, pens.byteOffset + i, 4).getUint32(0);
      const [x, y] = [lines[i] as number, lines[i + 1] as number];
      if (packed !== pen || x !== endX || y !== endY) {
        if (pen !== -1) {
          context.stroke();
        }
        context.beginPath();
        context.strokeStyle = `rgb(${pens[i]} ${pens[i + 1]} ${pens[i + 2]})`;
        context.lineWidth = pens[i + 3] as number;
        context.moveTo(x * unit, PIXELS - 1 - y * unit);
        pen = packed;
      }
      [endX, endY] = [lines[i + 2] as number, lines[i + 3] as number];
      context.lineTo(endX * unit, PIXELS - 1 - endY * unit);
    }
    if (pen !== -1) {
      context.stroke();
    }
  }

  async replace(drawing: GetTurtleDrawing_Response): Promise<void> {
    const { picture } = drawing;
    const bitmap = picture.length
      ? await createImageBitmap(new Blob([picture.slice()], { type: "image/png" }))
      : undefined;
    this.wipe();
    if (bitmap) {
      this.context.drawImage(bitmap, 0, 0, this.canvas.width, this.canvas.height);
      bitmap.close();
    }
    this.draw(drawing);
  }

  /** Change the size; the drawing is scaled until it is drawn again. */
  resize(size: number): void {
    const { canvas } = this;
    const before = canvas.width ? createCopy(canvas) : undefined;
    canvas.width = canvas.height = size;
    this.context.lineCap = this.context.lineJoin = "round";
    if (before) {
      this.context.drawImage(before, 0, 0, size, size);
    }
  }

  private scale(): void {
    const scale = this.canvas.width / PIXELS;
    this.context.setTransform(scale, 0, 0, scale, 0.5 * scale, 0.5 * scale);
  }
}

function createCopy(canvas: HTMLCanvasElement): HTMLCanvasElement {
  const copy = document.createElement("canvas");
  [copy.width, copy.height] = [canvas.width, canvas.height];
  copy.getContext("2d")?.drawImage(canvas, 0, 0);
  return copy;
}
