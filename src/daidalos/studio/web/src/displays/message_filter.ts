// Holds messages until the transform at their stamp is known: tf2_ros' message filter.
import type { Stamped } from "../contract";
import { toSeconds } from "../ros/time";
import { Transform, type TransformBuffer, type When } from "../tf/buffer";

const QUEUE = 10;
/** Page seconds after which a message is given up. */
const TIMEOUT_S = 2;

interface Held<M> {
  message: M;
  since: number;
}

const PROBE = new Transform();

export class MessageFilter<M extends Stamped> {
  private held: Held<M>[] = [];
  /** Why messages were given up; empty while all goes well. */
  error = "";

  add(message: M, page: number): void {
    this.held.push({ message, since: page });
    if (this.held.length > QUEUE) {
      this.held.shift();
    }
  }

  /** Return the messages that can be placed now, oldest first. */
  take(tf: TransformBuffer, fixed: string, page: number): M[] {
    const ready: M[] = [];
    this.held = this.held.filter(({ message, since }) => {
      const when = stampOf(message);
      const frame = frameOf(message);
      if (frame === fixed || tf.lookup(fixed, frame, when, PROBE)) {
        ready.push(message);
        return false;
      }
      if (page - since > TIMEOUT_S) {
        this.error = tf.explain(fixed, frame, when);
        return false;
      }
      return true;
    });
    if (ready.length) {
      this.error = "";
    }
    return ready;
  }
}

export function frameOf(message: Stamped): string {
  const frame = message.header.frame_id;
  return frame.startsWith("/") ? frame.slice(1) : frame;
}

/** A stamp of zero means "whatever is newest", as everywhere in ROS. */
export function stampOf(message: Stamped): When {
  return toSeconds(message.header.stamp) || "latest";
}
