import { describe, expect, it } from "vitest";
import type { PanelType } from "../panels/panel";
import { readFront, readOpening } from "./opening";

const plot = { id: "plot" } as PanelType;

describe("the page's address", () => {
  it("names a panel and what it is to show", () => {
    const opening = readOpening("?panel=plot&window=/turtlesim/_window&connect=ws://robot:8765", [plot]);
    expect(opening).toEqual({ panel: plot, details: { window: "/turtlesim/_window" } });
  });

  it("may want one to be in front", () => {
    expect(readFront("?front=plot", [plot])).toBe(plot);
    expect(readFront("?front=graph", [plot])).toBeUndefined();
    expect(readOpening("?front=plot", [plot])).toBeUndefined();
  });

  it("may name none, or one that does not exist", () => {
    expect(readOpening("", [plot])).toBeUndefined();
    expect(readOpening("?panel=graph", [plot])).toBeUndefined();
  });
});
