import { describe, expect, it } from "vitest";
import type { GetTurtleDrawing_Response, TurtleWindow } from "../../generated/daidalos_msgs";
import { DrawingFollower, type Lines, type Sheet } from "./follower";

/** A sheet that remembers the x of every line's start. */
class MemorySheet implements Sheet {
  marks: number[] = [];
  pictures = 0;
  wipe() {
    this.marks = [];
  }
  draw({ lines }: Lines) {
    for (let i = 0; i < lines.length; i += 4) {
      this.marks.push(lines[i] as number);
    }
  }
  async replace(drawing: GetTurtleDrawing_Response) {
    this.wipe();
    this.pictures += drawing.picture.length;
    this.draw(drawing);
  }
}

const lines = (...marks: number[]): Lines => ({
  lines: Float32Array.from(marks.flatMap((mark) => [mark, 0, 0, 0])),
  pens: new Uint8Array(4 * marks.length),
});
const received = (clearings: number, drawn: number, ...marks: number[]): TurtleWindow => ({
  ...lines(...marks),
  clearings,
  drawn,
  width: 11,
  height: 11,
  r: 0,
  g: 0,
  b: 0,
  turtles: [],
});
const answered = (clearings: number, drawn: number, ...marks: number[]): GetTurtleDrawing_Response => ({
  ...lines(...marks),
  clearings,
  drawn,
  picture: new Uint8Array(drawn > marks.length ? 1 : 0),
});
const settle = () => new Promise((resolve) => setTimeout(resolve));

describe("a follower", () => {
  it("draws what comes, once", async () => {
    const sheet = new MemorySheet();
    const follower = new DrawingFollower(sheet, async () => answered(0, 2, 1, 2));
    follower.receive(received(0, 2, 2));
    await settle();
    expect(sheet.marks).toEqual([1, 2]);
    follower.receive(received(0, 3, 3));
    follower.receive(received(0, 3));
    follower.receive(received(0, 5, 4, 5));
    expect(sheet.marks).toEqual([1, 2, 3, 4, 5]);
  });

  it("asks for everything when it missed something", async () => {
    const sheet = new MemorySheet();
    const answers = [answered(0, 1, 1), answered(0, 6, 1, 2, 3, 4, 5, 6)];
    const follower = new DrawingFollower(sheet, async () => answers.shift() as GetTurtleDrawing_Response);
    follower.receive(received(0, 1));
    await settle();
    follower.receive(received(0, 5, 5));
    await settle();
    follower.receive(received(0, 7, 6, 7));
    expect(sheet.marks).toEqual([1, 2, 3, 4, 5, 6, 7]);
    expect(answers).toEqual([]);
  });

  it("wipes the sheet when the simulator does", async () => {
    const sheet = new MemorySheet();
    const follower = new DrawingFollower(sheet, async () => answered(0, 1, 1));
    follower.receive(received(0, 1));
    await settle();
    follower.receive(received(1, 2, 8, 9));
    expect(sheet.marks).toEqual([8, 9]);
    follower.receive(received(2, 0));
    expect(sheet.marks).toEqual([]);
  });

  it("shows a picture of what is too old for lines", async () => {
    const sheet = new MemorySheet();
    const follower = new DrawingFollower(sheet, async () => answered(3, 100, 99, 100));
    follower.receive(received(3, 100));
    await settle();
    expect([sheet.pictures, ...sheet.marks]).toEqual([1, 99, 100]);
  });

  it("tries again after an answer that did not come", async () => {
    const sheet = new MemorySheet();
    let calls = 0;
    const follower = new DrawingFollower(sheet, async () => {
      if (++calls === 1) {
        throw new Error("there is no service");
      }
      return answered(0, 1, 1);
    });
    follower.receive(received(0, 1));
    await settle();
    follower.receive(received(0, 1));
    await settle();
    expect(sheet.marks).toEqual([1]);
  });
});
