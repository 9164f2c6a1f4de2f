// Grid: the ground, with lines that fade out towards the horizon.
import { BufferGeometry, Color, Float32BufferAttribute, LineBasicMaterial, LineSegments } from "three";
import { Layer } from "../../scene/layers";
import type { Settings } from "../../contract";
import { Display, disposeTree, place, type DisplayContext, type FrameInfo, type BuiltInDisplay } from "../display";
import { flag, number, text } from "../settings";

const MAJOR_EVERY = 5;
/** Each line is cut into pieces, so that its ends can fade. */
const PIECES = 10;

class Grid extends Display {
  constructor(context: DisplayContext, settings: Settings) {
    super(context, settings);
    this.restyle(settings);
  }

  override restyle(settings: Settings): void {
    super.restyle(settings);
    disposeTree(this.object);
    this.object.clear();
    const lines = new LineSegments(
      gridGeometry(
        number(settings, "cells"),
        number(settings, "size"),
        text(settings, "color"),
        flag(settings, "fade"),
      ),
      new LineBasicMaterial({
        vertexColors: true,
        transparent: true,
        opacity: number(settings, "alpha"),
        depthWrite: false,
      }),
    );
    lines.renderOrder = Layer.GRID;
    this.object.add(lines);
  }

  override update(frame: FrameInfo): void {
    place(this.context, this.object, frame.fixed, frame.fixed, "latest", true);
    this.report("ok", "");
  }
}

function gridGeometry(cells: number, size: number, color: string, fade: boolean): BufferGeometry {
  const half = (cells * size) / 2;
  const positions: number[] = [];
  const colors: number[] = [];
  const { r, g, b } = new Color(color);
  const strength = (x: number, y: number, weight: number) =>
    weight * (fade ? Math.max(0, 1 - Math.hypot(x, y) / (half * 1.02)) ** 1.4 : 1);
  for (let line = 0; line <= cells; line++) {
    const across = -half + line * size;
    const major = Math.abs(line - cells / 2) % MAJOR_EVERY === 0;
    const weight = major ? 1 : 0.45;
    for (let piece = 0; piece < PIECES; piece++) {
      for (const end of [piece, piece + 1]) {
        const along = -half + (end / PIECES) * 2 * half;
        positions.push(along, across, 0);
        colors.push(r, g, b, strength(along, across, weight));
      }
    }
    for (let piece = 0; piece < PIECES; piece++) {
      for (const end of [piece, piece + 1]) {
        const along = -half + (end / PIECES) * 2 * half;
        positions.push(across, along, 0);
        colors.push(r, g, b, strength(across, along, weight));
      }
    }
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new Float32BufferAttribute(positions, 3));
  geometry.setAttribute("color", new Float32BufferAttribute(colors, 4));
  return geometry;
}

export default {
  id: "Grid",
  icon: "grid",
  messages: [],
  properties: [
    { key: "cells", label: "Cells", kind: "number", min: 2, max: 200, step: 2 },
    { key: "size", label: "Cell size", kind: "number", min: 0.05, max: 100, step: 0.5, unit: "m" },
    { key: "color", label: "Colour", kind: "color" },
    { key: "alpha", label: "Alpha", kind: "number", min: 0, max: 1, step: 0.05 },
    { key: "fade", label: "Fade out", kind: "toggle" },
  ],
  defaults: { cells: 40, size: 1, color: "#8e99a6", alpha: 0.5, fade: true },
  create: (context, settings) => new Grid(context, settings),
} satisfies BuiltInDisplay;
