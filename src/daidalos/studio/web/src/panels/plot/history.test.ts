import { expect, it } from "vitest";
import { History } from "./history";

function filled(count: number, value = (i: number) => i): History {
  const history = new History();
  for (let i = 0; i < count; i++) {
    history.push(i, value(i));
  }
  return history;
}

it("grows, forgets and stays in order", () => {
  const history = filled(5000);
  history.forget(4000);
  expect(history.length).toBe(1001);
  for (let i = 5000; i < 9000; i++) {
    history.push(i, i);
    history.forget(i - 1000);
  }
  const { times, values } = history.decimate(-Infinity, Infinity, 1e6);
  expect(times[0]).toBe(7998);
  expect(times.at(-1)).toBe(8999);
  expect(values).toEqual(times);
  expect(times.every((time, i) => i === 0 || time > (times[i - 1] as number))).toBe(true);
});

it("keeps every peak beside values that are no numbers", () => {
  for (const first of [0, 1, 2]) {
    const history = filled(300, (i) => (i % 3 === first ? NaN : i === 151 ? 50 : i === 149 ? -50 : 0));
    const { values } = history.decimate(0, 300, 20);
    const numbers = values.filter((value) => !Number.isNaN(value));
    expect([Math.min(...numbers), Math.max(...numbers)]).toEqual([first === 2 ? 0 : -50, first === 1 ? 0 : 50]);
  }
});

it("keeps every peak when it leaves points out", () => {
  const history = filled(100_000, (i) => (i === 54_321 ? 100 : i === 12_345 ? -100 : Math.sin(i)));
  const { times, values } = history.decimate(0, 100_000, 200);
  expect(times.length).toBeLessThan(420);
  expect(Math.max(...values)).toBe(100);
  expect(Math.min(...values)).toBe(-100);
});

it("gives a window with the points beside it, so that lines reach its edges", () => {
  const { times } = filled(100).decimate(10.5, 20.5, 1000);
  expect(times).toEqual([10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21]);
});

it("starts anew when time is turned back", () => {
  const history = filled(10);
  history.push(2, 7);
  expect(history.length).toBe(1);
  expect(history.last).toBe(7);
});

it("is empty before the first value", () => {
  expect(new History().decimate(0, 1, 10)).toEqual({ times: [], values: [] });
  expect(new History().last).toBeUndefined();
});

it("tells the value at a time, and curves over each other", () => {
  const history = filled(10, (i) => i * i);
  expect(history.at(3)).toBe(9);
  expect(history.at(3.5)).toBe(9);
  expect(history.at(-1)).toBeUndefined();
  expect(history.at(99)).toBe(81);
  expect(filled(10).over(history, 2, 5, 100)).toEqual({ xs: [4, 9, 16], ys: [2, 3, 4] });
  expect(filled(1000).over(filled(1000), 0, 1000, 100).xs.length).toBe(100);
});
