// Messages and bytes per second of each subscribed topic, over the last two seconds.
import type { Traffic } from "./boundary";

const WINDOW_S = 2;

interface Count {
  total: number;
  messages: number;
  bytes: number;
  marks: { time: number; messages: number; bytes: number }[];
}

export class TrafficMeter {
  private readonly counts = new Map<string, Count>();

  open(topic: string, now: number): void {
    if (!this.counts.has(topic)) {
      this.counts.set(topic, { total: 0, messages: 0, bytes: 0, marks: [{ time: now, messages: 0, bytes: 0 }] });
    }
  }

  close(topic: string): void {
    this.counts.delete(topic);
  }

  add(topic: string, bytes: number): void {
    const count = this.counts.get(topic);
    if (count) {
      count.total++;
      count.messages++;
      count.bytes += bytes;
    }
  }

  /** Return the rates now, and drop what is older than the window. */
  measure(now: number): Record<string, Traffic> {
    const result: Record<string, Traffic> = {};
    for (const [topic, count] of this.counts) {
      const first = count.marks[0];
      const span = first ? now - first.time : 0;
      if (first) {
        result[topic] = {
          // A rate over less than the window would jump about.
          rate: span >= WINDOW_S ? (count.messages - first.messages) / span : undefined,
          bandwidth: span >= WINDOW_S ? (count.bytes - first.bytes) / span : undefined,
          total: count.total,
        };
      }
      count.marks.push({ time: now, messages: count.messages, bytes: count.bytes });
      while (count.marks.length > 1 && now - (count.marks[1]?.time ?? now) >= WINDOW_S) {
        count.marks.shift();
      }
    }
    return result;
  }
}
