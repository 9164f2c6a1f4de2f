// The application: the connection, the tree of frames, the clock, and the loop that draws.
import { effect, signal } from "@preact/signals";
import type { Arrangement } from "../generated/arrangement";
import { displaysOf } from "./arrangement";
import { Session } from "../connection/session";
import type * as contract from "../contract";
import { DisplayList } from "../displays/list";
import type { TFMessage } from "../generated/tf2_msgs";
import { Assets } from "../scene/assets";
import { TransformBuffer } from "../tf/buffer";
import { RobotClock } from "../tf/clock";
import { FixedFrame } from "../tf/fixed_frame";

const TF_KEEP = 2048;
/** Frames that come more seldom than this are not waited for when drawing. */
const SLOW_FRAME_S = 0.15;
const READ_OUT_S = 0.1;

export interface TimeReading {
  time: number | undefined;
  /** Simulated seconds per second; undefined where the time is not simulated, and until it is measured. */
  factor: number | undefined;
  isSimulated: boolean;
}

export class Studio implements contract.Studio {
  readonly session: Session;
  readonly tf = new TransformBuffer();
  readonly clock = new RobotClock();
  readonly fixedFrame: FixedFrame;
  readonly displays: DisplayList;
  readonly assets: Assets;
  readonly reading = signal<TimeReading>({ time: undefined, factor: undefined, isSimulated: false });
  /** The topic that the message panel shows. */
  readonly selectedTopic = signal("");
  /** Shows a panel; set by the layout. */
  openPanel: (id: string, params?: Record<string, unknown>, direction?: "right" | "below") => void = () => undefined;
  /** Adds a field to the plot that was used last; undefined: there is no plot. */
  readonly addToPlot = signal<((path: string) => void) | undefined>(undefined);
  /** Called when time was turned back or the server is another. */
  readonly onReset = new Set<() => void>();

  private readonly frames = new Set<(page: number) => void>();
  private readAt = 0;

  constructor(
    worker: Worker,
    /** The layout of a file, where one was opened. */
    readonly arrangement?: Arrangement,
    fixedFrame = arrangement?.fixedFrame,
  ) {
    this.fixedFrame = new FixedFrame(this.tf, fixedFrame);
    this.displays = new DisplayList(arrangement && displaysOf(arrangement));
    this.session = new Session(worker);
    this.assets = new Assets(this.session);
    this.session.onClock = ({ robot, at, announced }) =>
      this.clock.add(robot, (at - performance.timeOrigin) / 1000, announced);
    this.session.onNewServer = () => {
      this.tf.clear();
      this.assets.clear();
      this.reset();
    };
    this.tf.onReset = () => this.reset();
    this.session.subscribe<TFMessage>("/tf", TF_KEEP, (message) => this.receiveTransforms(message));
    this.session.subscribe<TFMessage>("/tf_static", TF_KEEP, ({ transforms }) => {
      for (const transform of transforms) {
        this.tf.set(transform, true);
      }
    });
    effect(() => this.displays.discover(this.session.topics.value));
  }

  start(url: string): void {
    this.session.open(url);
    document.addEventListener("visibilitychange", () => this.session.setVisible(!document.hidden));
    const loop = (milliseconds: number) => {
      requestAnimationFrame(loop);
      this.frame(milliseconds / 1000);
    };
    requestAnimationFrame(loop);
  }

  /** Call with the page's clock for every frame of the screen; returns how to stop. */
  onFrame(call: (page: number) => void): () => void {
    this.frames.add(call);
    return () => this.frames.delete(call);
  }

  /** Robot time, for stamps of what the page publishes. */
  now(): number {
    return this.clock.now(performance.now() / 1000) ?? Date.now() / 1000;
  }

  private frame(page: number): void {
    this.clock.tick(performance.now() / 1000);
    this.fixedFrame.refresh();
    if (page - this.readAt > READ_OUT_S) {
      this.readAt = page;
      this.readClock();
    }
    for (const call of this.frames) {
      call(page);
    }
  }

  private readClock(): void {
    const time = this.clock.now(performance.now() / 1000);
    const isSimulated = this.clock.announced;
    const factor = isSimulated ? this.clock.measuredRate : undefined;
    const before = this.reading.peek();
    if (before.time !== time || before.factor !== factor || before.isSimulated !== isSimulated) {
      this.reading.value = { time, factor, isSimulated };
    }
  }

  private receiveTransforms({ transforms }: TFMessage): void {
    this.measureAge();
    for (const transform of transforms) {
      this.tf.set(transform, false);
    }
  }

  /** Measure how old the newest transforms are just before new ones arrive: drawing is delayed by as much. */
  private measureAge(): void {
    const now = this.clock.now(performance.now() / 1000);
    if (now === undefined) {
      return;
    }
    let age = 0;
    for (const { newest, period } of this.tf.moving()) {
      if (period < SLOW_FRAME_S && now - newest < 1) {
        age = Math.max(age, now - newest);
      }
    }
    this.clock.addAge(age);
  }

  private reset(): void {
    this.clock.reset();
    for (const call of this.onReset) {
      call();
    }
  }
}
