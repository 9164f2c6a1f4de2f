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

it("says nothing of what was closed", () => {
  const meter = new TrafficMeter();
  meter.open("/a", 0);
  meter.close("/a");
  meter.add("/a", 1);
  expect(meter.measure(1)).toEqual({});
});
