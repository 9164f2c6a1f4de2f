import { expect, it } from "vitest";
import { placeLabels, type Anchor } from "./label_layout";

const HEIGHT = 19;

function overlaps(anchors: readonly Anchor[]): number {
  const boxes = placeLabels(anchors, HEIGHT).map(({ left, top }, i) => {
    const { x, y, width } = anchors[i] as Anchor;
    return { left: x + left, right: x + left + width, top: y + top, bottom: y + top + HEIGHT };
  });
  return boxes.flatMap((a, i) =>
    boxes
      .slice(i + 1)
      .filter((b) => a.left < b.right && b.left < a.right && a.top < b.bottom - 1e-6 && b.top < a.bottom - 1e-6),
  ).length;
}

it("leaves a label that is alone to the right of its point", () => {
  const [place] = placeLabels([{ x: 100, y: 100, width: 80 }], HEIGHT);
  expect(place?.left).toBeGreaterThan(0);
  expect(place?.top).toBe(-HEIGHT / 2);
});

it.each([
  ["in one point", Array.from({ length: 20 }, (_, i) => ({ x: 200, y: 300, width: 60 + 5 * i }))],
  ["close together", Array.from({ length: 24 }, (_, i) => ({ x: 200 + 7 * (i % 5), y: 300 + 4 * i, width: 90 }))],
])("lets no labels of frames %s overlap", (_, anchors) => {
  expect(overlaps(anchors)).toBe(0);
});
