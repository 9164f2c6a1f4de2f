// Robot time between its announcements: when "now" is, how fast it runs, and which moment to draw.

/** A jump of this much, in seconds, is a new time, not an error of ours. */
const JUMP_S = 0.75;
const CORRECTION = 0.1;
const RATE_WINDOW_S = 2.5;
/** Without news for this long, robot time stands still (a paused simulation). */
const STILL_S = 0.35;
/** Without news for this long, and seen so this many times, it is paused: what waits behind a busy page is news. */
const PAUSED_S = 1;
const STILL_TICKS = 4;
const MIN_DELAY_S = 0.01;
const MAX_DELAY_S = 0.3;

interface Mark {
  page: number;
  robot: number;
}

export class RobotClock {
  /** Robot seconds per second: the real-time factor of a simulation, 1 for a robot. */
  rate = 0;
  /** The rate for a reader: 0 while time stands still, undefined until it was measured over a whole window. */
  measuredRate: number | undefined;
  /** Whether the time comes from the server's clock rather than from messages. */
  announced = false;
  private marks: Mark[] = [];
  private estimate: Mark | undefined;
  private delay = 0.05;
  private drawn = -Infinity;
  private stillTicks = 0;

  /** Hear of robot time; `page` is the page's own clock, in seconds. */
  add(robot: number, page: number, announced: boolean): void {
    this.announced = announced;
    const expected = this.now(page);
    const error = expected === undefined ? Infinity : robot - expected;
    if (Math.abs(error) > JUMP_S) {
      if (!this.wasBusy(robot, page)) {
        this.marks = [];
        this.measuredRate = undefined;
      }
      this.drawn = -Infinity;
      this.estimate = { page, robot };
    } else {
      this.estimate = { page, robot: (expected as number) + CORRECTION * error };
    }
    this.marks.push({ page, robot });
    while (this.marks.length > 2 && page - (this.marks[0] as Mark).page > RATE_WINDOW_S) {
      this.marks.shift();
    }
    this.measureRate(page);
  }

  /** Robot time now; undefined before the first news. */
  now(page: number): number | undefined {
    if (!this.estimate) {
      return undefined;
    }
    const since = Math.min(page - this.estimate.page, STILL_S);
    return this.estimate.robot + since * this.rate;
  }

  /** Notice that robot time stands still. */
  tick(page: number): void {
    const last = this.marks.at(-1);
    this.stillTicks = last && page - last.page > PAUSED_S ? this.stillTicks + 1 : 0;
    if (last && this.stillTicks >= STILL_TICKS && this.rate !== 0) {
      this.estimate = { page, robot: last.robot };
      this.marks = [];
      this.rate = 0;
      this.measuredRate = 0;
    }
  }

  /** Hear how old the newest transform had become just before the next one came. */
  addAge(age: number): void {
    const wanted = Math.min(MAX_DELAY_S, Math.max(MIN_DELAY_S, age));
    // Up at once, so that nothing stutters; down slowly.
    this.delay += (wanted > this.delay ? 0.3 : 0.01) * (wanted - this.delay);
  }

  /** The moment to draw: a little in the past, where transforms are known on both sides; never going back. */
  drawingTime(page: number): number | undefined {
    const now = this.now(page);
    if (now === undefined) {
      return undefined;
    }
    const wanted = this.rate === 0 ? now : now - this.delay;
    if (wanted > this.drawn || this.drawn - wanted > JUMP_S) {
      this.drawn = wanted;
    }
    return this.drawn;
  }

  reset(): void {
    this.marks = [];
    this.estimate = undefined;
    this.drawn = -Infinity;
    this.rate = 0;
    this.measuredRate = undefined;
  }

  /** Whether a jump is no new time, but what a page that was busy for a while did not hear. */
  private wasBusy(robot: number, page: number): boolean {
    const last = this.marks.at(-1);
    return last !== undefined && Math.abs(robot - last.robot - (page - last.page) * this.rate) <= JUMP_S;
  }

  private measureRate(page: number): void {
    const first = this.marks[0];
    const last = this.marks.at(-1);
    const span = first ? page - first.page : 0;
    if (!first || !last || span < 0.25) {
      this.rate = this.rate || 1;
    } else {
      this.rate = (last.robot - first.robot) / span;
      this.measuredRate = span >= 0.8 * RATE_WINDOW_S ? this.rate : this.measuredRate || undefined;
    }
  }
}
