// Displays that show the messages of one topic.
import type { Stamped } from "../contract";
import type { Settings } from "../contract";
import { Display, place, type DisplayContext, type FrameInfo } from "./display";
import { frameOf, MessageFilter, stampOf } from "./message_filter";
import { text } from "./settings";

/** Shows each message of a topic when it arrives. */
export abstract class TopicDisplay<M> extends Display {
  protected count = 0;
  private readonly unsubscribe: () => void;

  constructor(context: DisplayContext, settings: Settings, keep = 1) {
    super(context, settings);
    this.report("idle", this.topic ? "no messages yet" : "no topic chosen");
    this.unsubscribe = this.topic
      ? context.session.subscribe<M>(this.topic, keep, (message) => {
          this.count++;
          this.receive(message);
          context.invalidate();
        })
      : () => undefined;
  }

  protected get topic(): string {
    return text(this.settings, "topic");
  }

  protected abstract receive(message: M): void;

  override dispose(): void {
    this.unsubscribe();
    super.dispose();
  }
}

/**
 * Shows the newest message of a topic in that message's own frame.
 *
 * "stamp" places it once where its frame was at its stamp, as what a sensor saw then; "latest" lets it follow its
 * frame, as a map does.
 */
export abstract class StampedDisplay<M extends Stamped> extends TopicDisplay<M> {
  protected shown: M | undefined;
  private readonly filter = new MessageFilter<M>();
  private newest: M[] = [];
  private placedIn = "";

  constructor(
    context: DisplayContext,
    settings: Settings,
    private readonly anchor: "stamp" | "latest",
    keep = 1,
  ) {
    super(context, settings, keep);
    this.object.visible = false;
  }

  /** Draw a message's content, relative to its frame. */
  protected abstract show(message: M): void;

  protected override receive(message: M): void {
    if (this.anchor === "stamp") {
      this.filter.add(message, performance.now() / 1000);
    } else {
      this.newest = [message];
    }
  }

  override restyle(settings: Settings): void {
    super.restyle(settings);
    if (this.shown) {
      this.show(this.shown);
    }
  }

  override update(frame: FrameInfo): void {
    const waiting = this.anchor === "stamp" ? this.filter.take(this.context.tf, frame.fixed, frame.page) : this.newest;
    this.newest = [];
    for (const message of waiting) {
      this.shown = message;
      this.show(message);
      this.put(frame, message);
    }
    if (this.shown && (this.anchor === "latest" || this.placedIn !== frame.fixed)) {
      this.put(frame, this.shown);
    }
    if (this.filter.error) {
      this.report("error", this.filter.error);
    }
  }

  private put(frame: FrameInfo, message: M): void {
    const source = frameOf(message);
    const moved = frame.fixed !== this.placedIn;
    const when = this.anchor === "latest" ? frame.time : stampOf(message);
    const found = place(this.context, this.object, frame.fixed, source, when, this.anchor === "latest" || moved);
    this.placedIn = found ? frame.fixed : "";
    if (this.object.visible !== found) {
      this.object.visible = found;
      this.context.invalidate();
    }
    if (found) {
      this.report("ok", this.describe(message));
    } else {
      this.report("error", this.context.tf.explain(frame.fixed, source, when));
    }
  }

  /** A few words about what is shown. */
  protected describe(message: M): string {
    return `in ${frameOf(message)}`;
  }
}
