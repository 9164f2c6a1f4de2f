// The first view of a scene: follows what appears in it, until the user moves the view or nothing new comes.
import { Box3, Vector3 } from "three";
import { frameView, type Content } from "./framing";
import type { View } from "./view";

const PERIOD_S = 0.3;
/** After as many seconds without anything new the view stays; at the latest this long after the first. */
const QUIET_S = 2;
const LONGEST_S = 12;
/** Of the content's size: less is not worth another view. */
const MIN_CHANGE = 0.08;
/** By how many times the robot's box grows, as parts appear, before it is framed again; turning alone changes it less. */
const MIN_GROWTH = 1.5;

export class FirstView {
  private shown: Content = { all: new Box3(), robot: new Box3() };
  private checkedAt = 0;
  private firstAt = 0;
  private changedAt = 0;
  private isOver = false;

  constructor(
    private readonly view: View,
    private readonly content: () => Content,
  ) {}

  /** Whether the view no longer changes by itself. */
  get isSettled(): boolean {
    return this.isOver || this.view.isMoved;
  }

  /** Follow what appears from now on again. */
  restart(): void {
    this.shown = { all: new Box3(), robot: new Box3() };
    this.firstAt = 0;
    this.isOver = false;
  }

  /** Bring the view up to date; `page` is the page's clock in seconds. */
  update(page: number, aspect: number): void {
    if (this.isSettled || page - this.checkedAt < PERIOD_S) {
      return;
    }
    this.checkedAt = page;
    const content = this.content();
    if (!content.all.isEmpty() && this.differs(content)) {
      this.shown = { all: content.all.clone(), robot: content.robot.clone() };
      this.firstAt ||= page;
      this.changedAt = page;
      this.view.restore(frameView(content, aspect));
    }
    this.isOver = this.firstAt > 0 && (page - this.changedAt > QUIET_S || page - this.firstAt > LONGEST_S);
  }

  private differs({ all, robot }: Content): boolean {
    return moved(this.shown.all, all) || grown(this.shown.robot, robot);
  }
}

/** Whether a box that may travel has appeared, gone or become larger. */
function grown(before: Box3, now: Box3): boolean {
  if (before.isEmpty() || now.isEmpty()) {
    return before.isEmpty() !== now.isEmpty();
  }
  return length(now) > MIN_GROWTH * length(before);
}

function length(box: Box3): number {
  return box.getSize(new Vector3()).length();
}

function moved(before: Box3, now: Box3): boolean {
  if (before.isEmpty() || now.isEmpty()) {
    return before.isEmpty() !== now.isEmpty();
  }
  return Math.max(before.min.distanceTo(now.min), before.max.distanceTo(now.max)) > MIN_CHANGE * length(now);
}
