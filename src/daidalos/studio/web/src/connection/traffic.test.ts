import { expect, it } from "vitest";
import { TrafficMeter } from "./traffic";

it("measures rate and bandwidth over the last seconds", () => {
  const meter = new TrafficMeter();
  meter.open("/a", 0);
  let result = {};
  for (let second = 1; second <= 6; second++) {
    for (let i = 0; i < (second <= 3 ? 100 : 10); i++) {
      meter.add("/a", 50);
    }
    result = meter.measure(second);
  }
  expect(result).toEqual({ "/a": { rate: 10, bandwidth: 500, total: 330 } });
});

it("tells no rate before it was measured long enough", () => {
  const meter = new TrafficMeter();
  meter.open("/a", 0);
  for (const time of [0.5, 1, 1.5, 2, 2.5]) {
    meter.add("/a", 50);
    const { rate } = meter.measure(time)["/a"] ?? {};
    expect(rate).toBe(time < 2 ? undefined : 2);
  }
});

it("says nothing of what was closed", () => {
  const meter = new TrafficMeter();
  meter.open("/a", 0);
  meter.close("/a");
  meter.add("/a", 1);
  expect(meter.measure(1)).toEqual({});
});
