import { describe, expect, it } from "vitest";
import type { Panel } from "../contract";
import type { RegisteredPanel } from "../panels/registry";
import { Registry } from "../registry";
import { asksForMore, readFront, readOpening } from "./opening";

const plot = { id: "plot" } as RegisteredPanel;
const panels = new Registry<Panel>({ plot });

describe("the page's address", () => {
  it("names a panel and what it is to show", () => {
    const opening = readOpening("?panel=plot&window=/turtlesim/_window&connect=ws://robot:8765", panels);
    expect(opening).toEqual({ panel: plot, details: { window: "/turtlesim/_window" } });
  });

  it("may want one to be in front", () => {
    expect(readFront("?front=plot", panels)).toBe(plot);
    expect(readFront("?front=graph", panels)).toBeUndefined();
    expect(readOpening("?front=plot", panels)).toBeUndefined();
  });

  it("may name none, or one that an installed package may bring", () => {
    expect(asksForMore("?panel=plot", panels)).toBe(false);
    expect(asksForMore("?front=battery", panels)).toBe(true);
    expect(readOpening("", panels)).toBeUndefined();
    expect(readOpening("?panel=graph", panels)).toBeUndefined();
  });
});
