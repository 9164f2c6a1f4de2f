// Marker: shapes that programs put into the scene.
import { Box3, Group } from "three";
import { Marker, type MarkerArray } from "../../generated/visualization_msgs";
import { toSeconds } from "../../ros/time";
import type { Settings } from "../../contract";
import { disposeTree, place, type DisplayContext, type FrameInfo, type BuiltInDisplay } from "../display";
import { markerObject } from "../marker_shapes";
import { frameOf, stampOf } from "../message_filter";
import { TopicDisplay } from "../topic_display";

const KEEP = 256;
const TIMEOUT_S = 2;

interface Shown {
  marker: Marker;
  holder: Group;
  since: number;
  placedIn: string;
}

class MarkerDisplay extends TopicDisplay<Marker | MarkerArray> {
  private readonly shown = new Map<string, Shown>();
  private error = "";

  constructor(context: DisplayContext, settings: Settings) {
    super(context, settings, KEEP);
  }

  protected override receive(message: Marker | MarkerArray): void {
    for (const marker of "markers" in message ? message.markers : [message]) {
      this.apply(marker);
    }
  }

  override update(frame: FrameInfo): void {
    let lost = "";
    for (const [key, shown] of this.shown) {
      const lifetime = toSeconds(shown.marker.lifetime);
      if (lifetime > 0 && frame.page - shown.since > lifetime) {
        this.remove(key);
      } else if (!this.put(shown, frame)) {
        lost = this.context.tf.explain(frame.fixed, frameOf(shown.marker), stampOf(shown.marker));
      }
    }
    if (lost || this.error) {
      this.report("error", this.error || lost);
    } else if (this.count) {
      this.report("ok", `${this.shown.size} markers`);
    }
  }

  override bounds(): Box3 {
    return new Box3().setFromObject(this.object);
  }

  private apply(marker: Marker): void {
    const key = `${marker.ns}\0${marker.id}`;
    if (marker.action === Marker.DELETEALL) {
      // Of one namespace where it is named, else of all.
      for (const [other, { marker: theirs }] of this.shown) {
        if (!marker.ns || theirs.ns === marker.ns) {
          this.remove(other);
        }
      }
      return;
    }
    this.remove(key);
    if (marker.action !== Marker.ADD) {
      return;
    }
    const object = markerObject(marker, {
      assets: this.context.assets,
      dark: this.context.theme() === "dark",
      changed: this.context.invalidate,
      onError: (text) => (this.error = text),
    });
    if (!object) {
      this.error = `marker type ${marker.type} is not known`;
      return;
    }
    const holder = new Group().add(object);
    holder.visible = false;
    this.object.add(holder);
    this.shown.set(key, { marker, holder, since: performance.now() / 1000, placedIn: "" });
  }

  private put(shown: Shown, frame: FrameInfo): boolean {
    const { marker, holder } = shown;
    if (shown.placedIn === frame.fixed && !marker.frame_locked) {
      return true;
    }
    const when = marker.frame_locked ? frame.time : stampOf(marker);
    const late = frame.page - shown.since > TIMEOUT_S;
    const clamp = marker.frame_locked || shown.placedIn !== "" || late;
    const found = place(this.context, holder, frame.fixed, frameOf(marker), when, clamp);
    if (found && !holder.visible) {
      holder.visible = true;
      this.context.invalidate();
    }
    shown.placedIn = found ? frame.fixed : shown.placedIn;
    return found || !late;
  }

  private remove(key: string): void {
    const shown = this.shown.get(key);
    if (shown) {
      disposeTree(shown.holder);
      shown.holder.removeFromParent();
      this.shown.delete(key);
      this.context.invalidate();
    }
  }
}

export default {
  id: "Marker",
  icon: "marker",
  discovery: "appears",
  messages: ["visualization_msgs/msg/Marker"],
  properties: [{ key: "topic", label: "Topic", kind: "topic" }],
  defaults: { topic: "" },
  create: (context, settings) => new MarkerDisplay(context, settings),
} satisfies BuiltInDisplay;
