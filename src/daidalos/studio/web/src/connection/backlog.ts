// Raw messages that wait in the worker until the page takes them: the newest of each topic, not yet decoded.

export interface Waiting {
  time: number;
  payload: Uint8Array;
}

interface Queue {
  keep: number;
  waiting: Waiting[];
}

export class Backlog {
  private readonly queues = new Map<string, Queue>();
  private filled = 0;

  /** Whether nothing waits. */
  get empty(): boolean {
    return this.filled === 0;
  }

  /** Keep this many messages of a topic; with 0 they are only counted elsewhere. */
  open(topic: string, keep: number): void {
    const queue = this.queues.get(topic);
    if (queue) {
      queue.keep = keep;
    } else {
      this.queues.set(topic, { keep, waiting: [] });
    }
  }

  close(topic: string): void {
    const queue = this.queues.get(topic);
    if (queue?.waiting.length) {
      this.filled--;
    }
    this.queues.delete(topic);
  }

  add(topic: string, time: number, payload: Uint8Array): void {
    const queue = this.queues.get(topic);
    if (!queue || queue.keep === 0) {
      return;
    }
    if (queue.waiting.length === 0) {
      this.filled++;
    } else if (queue.waiting.length >= queue.keep) {
      queue.waiting.shift();
    }
    queue.waiting.push({ time, payload });
  }

  /** Take all that waits, topic by topic, oldest first. */
  *take(): Iterable<[topic: string, waiting: Waiting[]]> {
    this.filled = 0;
    for (const [topic, queue] of this.queues) {
      if (queue.waiting.length) {
        const waiting = queue.waiting;
        queue.waiting = [];
        yield [topic, waiting];
      }
    }
  }

  clear(): void {
    for (const queue of this.queues.values()) {
      queue.waiting = [];
    }
    this.filled = 0;
  }
}
