// Which curves a plot has, as it remembers them: fields over time, or fields over another one.
import { isRecord } from "../../app/stored";
import type { Curve as FileCurve } from "../../generated/arrangement";

export interface Curve extends FileCurve {
  hidden: boolean;
}

const COLORS = ["#5aa9e6", "#f0a35e", "#62c98b", "#e86a92", "#a58be0", "#e3cf5b", "#54c7c1", "#c58f6b"] as const;

export function curveOf(path: string, over = ""): Curve {
  return { path, color: "", over, hidden: false };
}

/** Curves with a colour each. */
export function painted(curves: readonly Curve[]): readonly Curve[] {
  return curves.map((curve, i) => ({ ...curve, color: curve.color || (COLORS[i % COLORS.length] as string) }));
}

export function add(curves: readonly Curve[], path: string): readonly Curve[] {
  const over = curves[0]?.over ?? "";
  const isThere = path === over || curves.some((curve) => curve.path === path);
  return !path || isThere ? curves : [...curves, curveOf(path, over)];
}

/** Whether fields are drawn over fields. */
export function isXY(curves: readonly Curve[]): boolean {
  return curves.some(({ over }) => over !== "");
}

/** Draw all over the first one, or all over time again. */
export function turned(curves: readonly Curve[], toXY: boolean): readonly Curve[] {
  const [first, ...others] = curves;
  if (toXY) {
    return first && others.length ? others.map((curve) => ({ ...curve, over: first.path })) : curves;
  }
  const paths = new Set([...curves.map(({ over }) => over), ...curves.map(({ path }) => path)]);
  paths.delete("");
  return [...paths].map((path) => ({
    ...curveOf(path),
    color: curves.find((each) => each.path === path)?.color ?? "",
  }));
}

/** The curves of a saved layout or of a file. */
export function curvesIn(params: unknown): readonly Curve[] | undefined {
  if (!isRecord(params) || !Array.isArray(params.curves)) {
    return undefined;
  }
  const text = (value: unknown) => (typeof value === "string" ? value : "");
  return params.curves.filter(isRecord).flatMap(({ path, color, over, hidden }) => {
    return text(path) ? [{ path: text(path), color: text(color), over: text(over), hidden: hidden === true }] : [];
  });
}
