// Keeps a drawing up to date with turtlesim's: every message has the new lines; the whole drawing is requested when some were missed.

import type { GetTurtleDrawing_Response, TurtleWindow } from "../../generated/daidalos_msgs";

/** Lines by the four: both ends in units of turtlesim; red, green, blue and width of the pen. */
export type Lines = Pick<TurtleWindow, "lines" | "pens">;
type Progress = Pick<TurtleWindow, "clearings" | "drawn">;

export interface Sheet {
  wipe(): void;
  draw(lines: Lines): void;
  /** Show this drawing in place of what is there. */
  replace(drawing: GetTurtleDrawing_Response): Promise<void>;
}

export class DrawingFollower {
  private known: Progress | undefined;
  private asking = false;

  constructor(
    private readonly sheet: Sheet,
    private readonly ask: () => Promise<GetTurtleDrawing_Response>,
  ) {}

  receive(message: TurtleWindow): void {
    const fresh = message.lines.length / 4;
    if (message.drawn === fresh && this.known?.clearings !== message.clearings) {
      this.sheet.wipe();
      this.known = { clearings: message.clearings, drawn: 0 };
    }
    if (!this.known || this.known.clearings !== message.clearings) {
      void this.catchUp();
      return;
    }
    const missing = message.drawn - this.known.drawn;
    if (missing > fresh) {
      void this.catchUp();
    } else if (missing > 0) {
      this.sheet.draw(newest(message, missing));
      this.known.drawn = message.drawn;
    }
  }

  /** Draw the whole drawing again. */
  async catchUp(): Promise<void> {
    if (this.asking) {
      return;
    }
    this.asking = true;
    try {
      const drawing = await this.ask();
      await this.sheet.replace(drawing);
      this.known = { clearings: drawing.clearings, drawn: drawing.drawn };
    } catch {
      // The simulator is gone or not there yet: the next message leads here again.
      this.known = undefined;
    } finally {
      this.asking = false;
    }
  }
}

function newest({ lines, pens }: Lines, count: number): Lines {
  const first = lines.length - 4 * count;
  return { lines: lines.subarray(first), pens: pens.subarray(first) };
}
