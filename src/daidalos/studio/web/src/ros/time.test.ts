import { expect, it } from "vitest";
import { formatTime, toSeconds, toStamp } from "./time";

it.each([0, 1.5, 12.999_999_999_9, 1_700_000_000.25, -0.25])("keeps %f on the way to a stamp and back", (seconds) => {
  const stamp = toStamp(seconds);
  expect(stamp.nanosec).toBeGreaterThanOrEqual(0);
  expect(stamp.nanosec).toBeLessThan(1e9);
  expect(toSeconds(stamp)).toBeCloseTo(seconds, 6);
});

it("writes simulated time as minutes and tenths", () => {
  expect(formatTime(0)).toBe("0:00.0");
  expect(formatTime(83.25)).toBe("1:23.2");
  expect(formatTime(3723.99)).toBe("1:02:03.9");
});
