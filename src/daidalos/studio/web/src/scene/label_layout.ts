// Where the labels of points are drawn so that none lies over another.

export interface Anchor {
  /** The point, in pixels from the upper left corner. */
  x: number;
  y: number;
  /** Width of its label in pixels. */
  width: number;
}

/** Between a point and its label, in pixels. */
const GAP = 6;
const MAX_STEPS = 16;

interface Place {
  left: number;
  top: number;
}

/**
 * The upper left corners of labels of one height, relative to their points.
 *
 * Each takes the first free place: to the right of its point, above, below, to the left, then farther up and down.
 * Those of points that coincide make a list.
 */
export function placeLabels(anchors: readonly Anchor[], height: number): Place[] {
  const taken: (Place & { right: number })[] = [];
  return anchors.map(({ x, y, width }) => {
    const isFree = ({ left, top }: Place) =>
      taken.every(
        (other) =>
          x + left >= other.right ||
          x + left + width <= other.left ||
          y + top >= other.top + height ||
          y + top + height <= other.top,
      );
    const candidates = placesAround(width, height);
    const place = candidates.find(isFree) ?? (candidates[0] as Place);
    taken.push({ left: x + place.left, right: x + place.left + width, top: y + place.top });
    return place;
  });
}

function placesAround(width: number, height: number): Place[] {
  const [right, left] = [GAP, -GAP - width];
  const places: Place[] = [0, -1, 1].flatMap((row) => [{ left: right, top: (row - 0.5) * height }]);
  places.push(...[0, -1, 1].map((row) => ({ left, top: (row - 0.5) * height })));
  for (let row = 2; row <= MAX_STEPS; row++) {
    places.push({ left: right, top: (row - 0.5) * height }, { left: right, top: (-row - 0.5) * height });
    places.push({ left, top: (row - 0.5) * height }, { left, top: (-row - 0.5) * height });
  }
  return places;
}
