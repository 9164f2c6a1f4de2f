// The values of one curve over time: a ring buffer that is appended at the end and dropped at the beginning.

const FIRST_ROOM = 1024;

export class History {
  private times = new Float64Array(FIRST_ROOM);
  private values = new Float64Array(FIRST_ROOM);
  private start = 0;
  private end = 0;

  get length(): number {
    return this.end - this.start;
  }

  get last(): number | undefined {
    return this.length ? this.values[this.end - 1] : undefined;
  }

  get lastTime(): number | undefined {
    return this.length ? this.times[this.end - 1] : undefined;
  }

  push(time: number, value: number): void {
    if (this.lastTime !== undefined && time < this.lastTime) {
      // Time was turned back: what was belongs to another run.
      this.clear();
    }
    if (this.end === this.times.length) {
      this.makeRoom();
    }
    this.times[this.end] = time;
    this.values[this.end] = value;
    this.end++;
  }

  /** Drop what is older, but for one sample that a line may come from. */
  forget(before: number): void {
    while (this.length > 1 && (this.times[this.start + 1] as number) < before) {
      this.start++;
    }
  }

  clear(): void {
    this.start = this.end = 0;
  }

  /**
   * The curve between two times with at most `buckets` pairs of points: each bucket's least and greatest value, so
   * that no peak is lost.
   */
  decimate(from: number, to: number, buckets: number): { times: number[]; values: number[] } {
    const times: number[] = [];
    const values: number[] = [];
    const first = Math.max(this.start, this.indexOf(from) - 1);
    const last = Math.min(this.end, this.indexOf(to) + 1);
    const step = Math.max(1, Math.ceil((last - first) / buckets));
    for (let i = first; i < last; i += step) {
      const stop = Math.min(last, i + step);
      let [least, most] = [i, i];
      for (let j = i + 1; j < stop; j++) {
        const value = this.values[j] as number;
        if (!Number.isNaN(value)) {
          // Written so that any number takes the place of NaN, which is neither greater nor less than anything.
          least = value >= (this.values[least] as number) ? least : j;
          most = value <= (this.values[most] as number) ? most : j;
        }
      }
      for (const at of least === most ? [least] : [Math.min(least, most), Math.max(least, most)]) {
        times.push(this.times[at] as number);
        values.push(this.values[at] as number);
      }
    }
    return { times, values };
  }

  /** The newest value at a time; undefined before the first one. */
  at(time: number): number | undefined {
    const index = this.indexOf(time);
    const is = index < this.end && this.times[index] === time;
    const found = is ? index : index - 1;
    return found >= this.start ? this.values[found] : undefined;
  }

  /** The values of this curve over those that another one had at the same times, thinned to at most `most`. */
  over(other: History, from: number, to: number, most: number): { xs: number[]; ys: number[] } {
    const [xs, ys]: [number[], number[]] = [[], []];
    const [first, last] = [this.indexOf(from), this.indexOf(to)];
    const step = Math.max(1, Math.ceil((last - first) / most));
    for (let i = first; i < last; i += step) {
      const x = other.at(this.times[i] as number);
      if (x !== undefined) {
        xs.push(x);
        ys.push(this.values[i] as number);
      }
    }
    return { xs, ys };
  }

  /** The index of the first sample at or after a time. */
  private indexOf(time: number): number {
    let [low, high] = [this.start, this.end];
    while (low < high) {
      const middle = (low + high) >> 1;
      if ((this.times[middle] as number) < time) {
        low = middle + 1;
      } else {
        high = middle;
      }
    }
    return low;
  }

  private makeRoom(): void {
    const used = this.length;
    const room = used > this.times.length / 2 ? this.times.length * 2 : this.times.length;
    const [times, values] = [new Float64Array(room), new Float64Array(room)];
    times.set(this.times.subarray(this.start, this.end));
    values.set(this.values.subarray(this.start, this.end));
    [this.times, this.values, this.start, this.end] = [times, values, 0, used];
  }
}
