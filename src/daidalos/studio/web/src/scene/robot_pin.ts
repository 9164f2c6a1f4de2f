// A label over a robot that is small in the view; presses go through it, to what is there.
import { Box3, Vector3 } from "three";
import type { Viewport } from "./viewport";

/** The pin is there where the robot's diagonal spans fewer pixels. */
const SMALL_PX = 56;

/** Where a robot is pinned, in pixels from the upper left corner; undefined where it is large, or out of view. */
export function pinPlace(robot: Box3, viewport: Pick<Viewport, "project" | "view" | "width" | "height">) {
  if (robot.isEmpty()) {
    return undefined;
  }
  const top = robot.getCenter(new Vector3()).setZ(robot.max.z);
  const { view, width, height } = viewport;
  const { x, y } = viewport.project(top);
  const isInside = x > 0 && y > 0 && x < width && y < height && view.isAhead(top);
  const pixels = robot.getSize(new Vector3()).length() / view.metresPerPixel(top, height);
  return isInside && pixels < SMALL_PX ? { x, y } : undefined;
}

export class RobotPin {
  private readonly element = document.createElement("div");

  constructor(
    container: HTMLElement,
    private readonly viewport: Viewport,
  ) {
    this.element.className = "robot-pin";
    this.element.dataset.test = "robot-pin";
    this.element.hidden = true;
    container.append(this.element);
  }

  /** Show the pin where the robot is in the present view. */
  update(robot: Box3, name: string): void {
    const place = pinPlace(robot, this.viewport);
    this.element.hidden = !place;
    if (place) {
      this.element.textContent = name || "robot";
      this.element.style.transform = `translate(-50%, -100%) translate(${place.x.toFixed(1)}px, ${place.y.toFixed(1)}px)`;
    }
  }

  dispose(): void {
    this.element.remove();
  }
}
