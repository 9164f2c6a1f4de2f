// The 3-D view put together: canvas, displays, tools and the camera that may follow the robot.
import { effect, signal } from "@preact/signals";
import { Group, Vector3 } from "three";
import { isRecord, isString, read, write } from "../app/stored";
import type { Studio } from "../app/studio";
import { theme } from "../app/theme";
import { DisplayManager } from "../displays/manager";
import type { FrameInfo } from "../displays/display";
import { Transform } from "../tf/buffer";
import { Toolbox } from "../tools/toolbox";
import { FirstView } from "./first_view";
import { frameView, type Content } from "./framing";
import { DAYLIGHT, DUSK } from "./looks";
import { RobotPin } from "./robot_pin";
import { HOME, type ViewKind, type ViewState } from "./view";
import { Viewport } from "./viewport";

const VIEW_KEY = "view";
const FOLLOW_KEY = "follow";
const SAVE_EVERY_S = 2;
/** Frames that the shadow and "follow" use, in order of preference. */
const ROBOT_FRAMES = ["base_footprint", "base_link", "base"];

/** The frame that the camera moves along with; empty: none. */
export const followed = signal("");

export class World {
  readonly viewport: Viewport;
  readonly toolbox: Toolbox;
  readonly viewKind = signal<ViewKind>("orbit");
  private readonly content = new Group();
  private readonly overlay = new Group();
  private readonly manager: DisplayManager;
  private readonly stops: (() => void)[] = [];
  private readonly first: FirstView;
  private readonly pin: RobotPin;
  private readonly followedAt = new Vector3();
  private followedNow = "";
  /** The fixed frame of the first view. */
  private framedIn = "";
  private savedAt = 0;
  private savedView = "";

  constructor(
    container: HTMLElement,
    private readonly studio: Studio,
    visible: () => boolean,
  ) {
    this.viewport = new Viewport(container);
    const { viewport } = this;
    viewport.scene.add(this.content, this.overlay);
    const { arrangement } = studio;
    const kept = arrangement?.view ?? read<ViewState | undefined>(VIEW_KEY, undefined, isViewState);
    followed.value = arrangement?.followed ?? read(FOLLOW_KEY, "", isString);
    viewport.view.restore(kept ?? HOME);
    viewport.view.isMoved = kept !== undefined;
    this.viewKind.value = viewport.view.kind;
    this.manager = new DisplayManager(
      studio.displays,
      {
        session: studio.session,
        tf: studio.tf,
        assets: studio.assets,
        theme: () => theme.value,
        invalidate: viewport.invalidate,
      },
      this.content,
    );
    this.first = new FirstView(viewport.view, () => this.seen());
    this.pin = new RobotPin(container, viewport);
    this.toolbox = new Toolbox(viewport, {
      overlay: this.overlay,
      fixedFrame: () => studio.fixedFrame.current.value,
      now: () => studio.now(),
      publish: (topic, type, message) => studio.session.publish(topic, type, message),
      focusOn: (point) => viewport.view.lookAt(point),
      invalidate: viewport.invalidate,
    });
    const observer = new ResizeObserver(() => viewport.resize(container.clientWidth, container.clientHeight));
    observer.observe(container);
    const reset = () => this.manager.reset();
    studio.onReset.add(reset);
    this.stops.push(
      () => observer.disconnect(),
      () => studio.onReset.delete(reset),
      effect(() => {
        if (!arrangement) {
          write(FOLLOW_KEY, followed.value);
        }
      }),
      effect(() => {
        viewport.look = theme.value === "dark" ? DUSK : DAYLIGHT;
      }),
      studio.onFrame((page) => {
        if (visible()) {
          this.frame(page);
        }
      }),
    );
  }

  switchView(kind: ViewKind): void {
    this.viewport.view.switchTo(kind);
    this.viewKind.value = kind;
  }

  /** Restore the view of all there is, or of the origin where there is nothing. */
  home(): void {
    const content = this.seen();
    const view = content.all.isEmpty() ? HOME : frameView(content, this.viewport.aspect);
    this.viewport.view.restore({ ...view, kind: this.viewKind.value });
  }

  /** Whether the view no longer changes by itself. */
  get isSettled(): boolean {
    return this.first.isSettled;
  }

  follow(frame: string): void {
    followed.value = frame;
    if (frame) {
      const pose = this.poseOf(frame);
      if (pose) {
        this.viewport.view.lookAt(pose.position.clone().setZ(this.viewport.view.focus.z));
      }
    }
  }

  /** The robot's own frame, where TF has one. */
  robotFrame(): string | undefined {
    return ROBOT_FRAMES.find((frame) => this.studio.tf.has(frame));
  }

  /** Where a frame is drawn at present, in the fixed frame. */
  poseOf(frame: string): Transform | undefined {
    const pose = new Transform();
    const fixed = this.studio.fixedFrame.current.value;
    return this.studio.tf.lookup(fixed, frame, this.drawingTime(), pose, { clamp: true }) ? pose : undefined;
  }

  dispose(): void {
    for (const stop of this.stops) {
      stop();
    }
    this.pin.dispose();
    this.toolbox.dispose();
    this.manager.dispose();
    this.viewport.dispose();
  }

  private frame(page: number): void {
    const info: FrameInfo = {
      fixed: this.studio.fixedFrame.current.value,
      time: this.drawingTime(),
      page,
      view: this.viewport.view,
      width: this.viewport.width,
      height: this.viewport.height,
    };
    this.manager.update(info);
    this.followRobot();
    if (this.framedIn !== info.fixed) {
      this.framedIn = info.fixed;
      this.first.restart();
    }
    this.first.update(page, this.viewport.aspect);
    this.viewport.frame(page);
    this.pin.update(this.manager.robotBounds(), this.robotFrame() ?? "");
    this.keepView(page);
  }

  private seen(): Content {
    return { ...this.manager.bounds(), sees: (from, to, within) => this.viewport.sees(from, to, within) };
  }

  private drawingTime(): number | "latest" {
    return this.studio.clock.drawingTime(performance.now() / 1000) ?? "latest";
  }

  private robotAt(): Vector3 | undefined {
    const frame = this.robotFrame();
    return frame === undefined ? undefined : this.poseOf(frame)?.position;
  }

  private followRobot(): void {
    const robot = this.robotAt();
    if (robot) {
      this.viewport.lights.follow(robot);
    }
    const frame = followed.value;
    const at = frame ? this.poseOf(frame)?.position : undefined;
    if (at && this.followedNow === frame) {
      this.viewport.view.shift(at.clone().sub(this.followedAt).setZ(0));
    }
    this.followedNow = at ? frame : "";
    if (at) {
      this.followedAt.copy(at);
    }
  }

  private keepView(page: number): void {
    if (page - this.savedAt > SAVE_EVERY_S && !this.studio.arrangement) {
      this.savedAt = page;
      const view = this.viewport.view.state();
      const text = JSON.stringify(view);
      if (text !== this.savedView && this.viewport.view.isMoved) {
        this.savedView = text;
        write(VIEW_KEY, view);
      }
    }
  }
}

function isViewState(value: unknown): value is ViewState {
  return (
    isRecord(value) &&
    (value.kind === "orbit" || value.kind === "top") &&
    Array.isArray(value.focus) &&
    value.focus.length === 3 &&
    [...value.focus, value.distance, value.yaw, value.pitch].every((each) => Number.isFinite(each))
  );
}
