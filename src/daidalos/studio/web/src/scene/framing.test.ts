import { Box3, PerspectiveCamera, Vector3 } from "three";
import { describe, expect, it } from "vitest";
import { frameView } from "./framing";
import { FIELD_OF_VIEW_DEG, HOME, type ViewState } from "./view";

const ASPECT = 1.4;

/** Where a point is on the screen, from -1 to 1 each way. */
function seen({ focus, distance, yaw, pitch }: ViewState, point: Vector3): Vector3 {
  const camera = new PerspectiveCamera(FIELD_OF_VIEW_DEG, ASPECT, 0.02, 2000);
  camera.up.set(0, 0, 1);
  const level = Math.cos(pitch) * distance;
  const at = new Vector3().fromArray(focus);
  camera.position.set(Math.cos(yaw) * level, Math.sin(yaw) * level, Math.sin(pitch) * distance).add(at);
  camera.lookAt(at);
  camera.updateMatrixWorld();
  return point.clone().project(camera);
}

const box = (x: number, y: number, size: number, height: number) =>
  new Box3(new Vector3(x - size / 2, y - size / 2, 0), new Vector3(x + size / 2, y + size / 2, height));

function cornersOf({ min, max }: Box3): Vector3[] {
  return [0, 1, 2, 3, 4, 5, 6, 7].map(
    (i) => new Vector3(i & 1 ? min.x : max.x, i & 2 ? min.y : max.y, i & 4 ? min.z : max.z),
  );
}

/** The share of the view's height that a box has. */
function heightOf(view: ViewState, what: Box3): number {
  const rows = cornersOf(what).map((corner) => seen(view, corner).y);
  return (Math.max(...rows) - Math.min(...rows)) / 2;
}

describe("the first view", () => {
  it.each([
    ["a table's", box(1, -2, 0.8, 0.7)],
    ["a room's", box(3, 4, 6, 1)],
    ["a hall's", box(-40, 0, 60, 9)],
  ])("shows all of %s corners, and wastes little", (_, all) => {
    const view = frameView(all, undefined, ASPECT);
    const places = cornersOf(all).map((corner) => seen(view, corner));
    const largest = Math.max(...places.flatMap(({ x, y }) => [Math.abs(x), Math.abs(y)]));
    expect(largest).toBeLessThan(0.9);
    expect(largest).toBeGreaterThan(0.75);
  });

  it("comes nearer where a robot would be a dot in a room of 16 m, and keeps it in sight", () => {
    const room = box(0, 0, 16, 2.5);
    const robot = box(-7, -6.5, 0.3, 0.2);
    expect(heightOf(frameView(room, undefined, ASPECT), robot)).toBeLessThan(0.035);
    const view = frameView(room, robot, ASPECT);
    expect(heightOf(view, robot)).toBeGreaterThan(0.045);
    const middle = seen(view, robot.getCenter(new Vector3()));
    expect(Math.max(Math.abs(middle.x), Math.abs(middle.y))).toBeLessThan(0.75);
  });

  it("does not come nearer for a robot that is large enough", () => {
    const room = box(0, 0, 6, 1);
    const robot = box(1, 1, 1.2, 1);
    expect(frameView(room, robot, ASPECT)).toEqual(frameView(room, undefined, ASPECT));
  });

  it("shows the surroundings of a small thing alone", () => {
    const { distance } = frameView(box(0, 0, 0.01, 0.01), undefined, ASPECT, HOME);
    expect(distance).toBeCloseTo(0.9);
  });
});
