import { expect, it } from "vitest";
import { RobotClock } from "./clock";

/** A simulation at a constant speed that tells its time so many times a second. */
function run(clock: RobotClock, factor: number, seconds: number, from = 0, hertz = 50): number {
  for (let i = 0; i <= seconds * hertz; i++) {
    const page = from + i / hertz;
    clock.add(100 + factor * page, page, true);
  }
  return from + seconds;
}

it.each([0.25, 1, 4])("measures a real-time factor of %f", (factor) => {
  const clock = new RobotClock();
  const page = run(clock, factor, 4);
  expect(clock.rate).toBeCloseTo(factor, 2);
  expect(clock.now(page + 0.1)).toBeCloseTo(100 + factor * (page + 0.1), 2);
});

it("tells a reader no factor before it was measured long enough", () => {
  const clock = new RobotClock();
  run(clock, 0.5, 1);
  expect(clock.measuredRate).toBeUndefined();
  run(clock, 0.5, 3);
  expect(clock.measuredRate).toBeCloseTo(0.5, 2);
});

it("keeps the factor when the page was busy for a while", () => {
  const clock = new RobotClock();
  run(clock, 1, 4);
  clock.add(100 + 5.4, 5.4, true);
  expect(clock.now(5.4)).toBeCloseTo(105.4);
  expect(clock.measuredRate).toBeCloseTo(1, 2);
});

it("draws in the past, steadily, and never goes back", () => {
  const clock = new RobotClock();
  let before = -Infinity;
  for (let i = 0; i < 300; i++) {
    const page = i / 60;
    if (i % 3 === 0) {
      clock.add(page + 0.004 * Math.sin(7 * i), page, true);
      clock.addAge(0.05);
    }
    const drawn = clock.drawingTime(page) as number;
    expect(drawn).toBeGreaterThanOrEqual(before);
    if (i > 120) {
      expect(drawn - before).toBeLessThan(0.04);
      expect(page - drawn).toBeGreaterThan(0.02);
      expect(page - drawn).toBeLessThan(0.12);
    }
    before = drawn;
  }
});

it("notices a pause and catches up with the last moment", () => {
  const clock = new RobotClock();
  const page = run(clock, 1, 3);
  clock.tick(page + 1);
  expect(clock.rate).toBeCloseTo(1); // what came meanwhile may wait behind a busy page
  [1.1, 1.2, 1.3, 1.4].forEach((later) => clock.tick(page + later));
  expect(clock.rate).toBe(0);
  expect(clock.now(page + 5)).toBeCloseTo(100 + page);
  expect(clock.drawingTime(page + 5)).toBeCloseTo(100 + page);
});

it("follows a jump, forth and back", () => {
  const clock = new RobotClock();
  const page = run(clock, 1, 2);
  clock.add(5000, page + 0.02, true);
  expect(clock.now(page + 0.02)).toBe(5000);
  expect(clock.drawingTime(page + 0.02)).toBeLessThanOrEqual(5000);
  clock.add(1, page + 0.04, true);
  expect(clock.now(page + 0.04)).toBe(1);
  expect(clock.drawingTime(page + 0.04)).toBeLessThanOrEqual(1);
});

it("knows nothing before the first news", () => {
  const clock = new RobotClock();
  expect(clock.now(3)).toBeUndefined();
  expect(clock.drawingTime(3)).toBeUndefined();
});
