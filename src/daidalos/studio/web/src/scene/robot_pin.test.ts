import { Box3, PerspectiveCamera, Vector3 } from "three";
import { expect, test } from "vitest";
import { pinPlace } from "./robot_pin";
import { FIELD_OF_VIEW_DEG } from "./view";

const [WIDTH, HEIGHT] = [1200, 800];

/** A view from a distance above the origin, looking along x, as the pin needs it. */
function viewportAt(distance: number) {
  const camera = new PerspectiveCamera(FIELD_OF_VIEW_DEG, WIDTH / HEIGHT, 0.02, 2000);
  camera.up.set(0, 0, 1);
  camera.position.set(-distance, 0, 0);
  camera.lookAt(0, 0, 0);
  camera.updateMatrixWorld();
  const depth = (at: Vector3) => at.x + distance;
  const view = {
    isAhead: (at: Vector3) => depth(at) > 0,
    metresPerPixel: (at: Vector3) => (2 * depth(at) * Math.tan((FIELD_OF_VIEW_DEG * Math.PI) / 360)) / HEIGHT,
  };
  const project = (point: Vector3) => {
    const at = point.clone().project(camera);
    return { x: ((at.x + 1) / 2) * WIDTH, y: ((1 - at.y) / 2) * HEIGHT };
  };
  return { project, view, width: WIDTH, height: HEIGHT } as unknown as Parameters<typeof pinPlace>[1];
}

const robotAt = (x: number, y: number) =>
  new Box3(new Vector3(x - 0.2, y - 0.2, 0), new Vector3(x + 0.2, y + 0.2, 0.2));

test("a robot that is far away is pinned above its top", () => {
  const place = pinPlace(robotAt(0, 0), viewportAt(20));
  expect(place?.x).toBeCloseTo(WIDTH / 2);
  expect(place?.y).toBeLessThan(HEIGHT / 2);
});

test.each([
  ["is large in the view", robotAt(0, 0), 3],
  ["is beside the view", robotAt(0, 30), 20],
  ["is behind the camera", robotAt(-40, 0), 20],
  ["is not there", new Box3(), 20],
])("no pin where the robot %s", (_, robot, distance) => {
  expect(pinPlace(robot, viewportAt(distance))).toBeUndefined();
});
