import { Box3, PerspectiveCamera, Vector3 } from "three";
import { describe, expect, it } from "vitest";
import { frameView } from "./framing";
import { FIELD_OF_VIEW_DEG, HOME, type ViewState } from "./view";

const ASPECT = 1.4;
const NONE = new Box3();

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
    const view = frameView({ all, robot: NONE }, ASPECT);
    const places = cornersOf(all).map((corner) => seen(view, corner));
    const largest = Math.max(...places.flatMap(({ x, y }) => [Math.abs(x), Math.abs(y)]));
    expect(largest).toBeLessThan(0.9);
    expect(largest).toBeGreaterThan(0.75);
  });

  it("shows all of a room of 16 m with a small robot in it", () => {
    const room = box(0, 0, 16, 2.5);
    const robot = box(-7, -6.5, 0.4, 0.3);
    expect(frameView({ all: room, robot }, ASPECT)).toEqual(frameView({ all: room, robot: NONE }, ASPECT));
  });

  it("comes nearer where a robot would be a dot in a hall of 60 m, and keeps it in sight", () => {
    const hall = box(0, 0, 60, 9);
    const robot = box(-27, -26.5, 0.4, 0.3);
    const view = frameView({ all: hall, robot }, ASPECT);
    expect(heightOf(view, robot)).toBeGreaterThan(2 * heightOf(frameView({ all: hall, robot: NONE }, ASPECT), robot));
    const middle = seen(view, robot.getCenter(new Vector3()));
    expect(Math.max(Math.abs(middle.x), Math.abs(middle.y))).toBeLessThan(0.75);
  });

  it("looks down more steeply where walls hide the robot", () => {
    const room = box(0, 0, 8, 2.5);
    const robot = box(1, 1, 0.5, 0.4);
    /** A wall of the room's height stands one metre in front of the robot. */
    const sees = (from: Vector3, to: Vector3) => {
      const share = 1 / from.clone().sub(to).setZ(0).length();
      return to.z + share * (from.z - to.z) > 2.5;
    };
    const view = frameView({ all: room, robot, sees }, ASPECT);
    expect(view.pitch).toBeGreaterThan(1);
    for (const corner of cornersOf(room).map((each) => seen(view, each))) {
      expect(Math.max(Math.abs(corner.x), Math.abs(corner.y))).toBeLessThan(0.9);
    }
    expect(frameView({ all: room, robot, sees: () => false }, ASPECT).pitch).toBe(HOME.pitch);
  });

  it("does not come nearer for a robot that is large enough", () => {
    const room = box(0, 0, 6, 1);
    const robot = box(1, 1, 1.2, 1);
    expect(frameView({ all: room, robot }, ASPECT)).toEqual(frameView({ all: room, robot: NONE }, ASPECT));
  });

  it("shows the surroundings of a small thing alone", () => {
    const { distance } = frameView({ all: box(0, 0, 0.01, 0.01), robot: NONE }, ASPECT, HOME);
    expect(distance).toBeCloseTo(0.9);
  });
});
