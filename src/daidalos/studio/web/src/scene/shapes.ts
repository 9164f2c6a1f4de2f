// Shapes that several displays draw: arrows, axes, labels, thick lines.
import {
  BufferGeometry,
  CanvasTexture,
  Color,
  ConeGeometry,
  CylinderGeometry,
  Float32BufferAttribute,
  SRGBColorSpace,
  Sprite,
  SpriteMaterial,
} from "three";
import { mergeGeometries } from "three/examples/jsm/utils/BufferGeometryUtils.js";
import { Line2 } from "three/examples/jsm/lines/Line2.js";
import { LineGeometry } from "three/examples/jsm/lines/LineGeometry.js";
import { LineMaterial } from "three/examples/jsm/lines/LineMaterial.js";
import { Layer } from "./layers";

export interface ArrowShape {
  shaftLength: number;
  shaftRadius: number;
  headLength: number;
  headRadius: number;
}

/** An arrow from the origin along +x. */
export function arrowGeometry({ shaftLength, shaftRadius, headLength, headRadius }: ArrowShape): BufferGeometry {
  const shaft = new CylinderGeometry(shaftRadius, shaftRadius, shaftLength, 20);
  shaft.translate(0, shaftLength / 2, 0);
  const head = new ConeGeometry(headRadius, headLength, 24);
  head.translate(0, shaftLength + headLength / 2, 0);
  const arrow = mergeGeometries([shaft, head]);
  shaft.dispose();
  head.dispose();
  return arrow.rotateZ(-Math.PI / 2);
}

/** Lines with a width in pixels at any distance. */
export function thickLine(color: Color | string | number, width: number): Line2 {
  const material = new LineMaterial({ color: new Color(color).getHex(), linewidth: width, transparent: true });
  const line = new Line2(new LineGeometry(), material);
  line.frustumCulled = false;
  return line;
}

/** Give a thick line new points (x, y, z one after another). */
export function setLinePoints(line: Line2, points: number[] | Float32Array): void {
  // A line's buffers cannot grow: a new geometry is what the library expects.
  line.geometry.dispose();
  const geometry = new LineGeometry();
  if (points.length >= 6) {
    geometry.setPositions(points);
  }
  line.geometry = geometry;
  line.visible = points.length >= 6;
}

const LETTERS_PX = 32;
const MARGIN_PX = 7;

/** Text that faces the camera. */
export class Label extends Sprite {
  private shown = "";
  /** Its width, in heights. */
  ratio = 1;

  constructor(
    text: string,
    private color: string,
    private halo: string,
  ) {
    super(new SpriteMaterial({ transparent: true, depthTest: false, depthWrite: false, sizeAttenuation: true }));
    this.renderOrder = Layer.LABEL;
    this.userData.sharesGeometry = true; // all sprites have one
    this.center.set(-0.04, -0.2);
    this.write(text);
  }

  get text(): string {
    return this.shown;
  }

  write(text: string, color = this.color, halo = this.halo): void {
    if (text === this.shown && color === this.color && halo === this.halo) {
      return;
    }
    [this.shown, this.color, this.halo] = [text, color, halo];
    const canvas = document.createElement("canvas");
    const pen = canvas.getContext("2d") as CanvasRenderingContext2D;
    const font = `500 ${LETTERS_PX}px system-ui, sans-serif`;
    pen.font = font;
    canvas.width = Math.ceil(pen.measureText(text).width) + 2 * MARGIN_PX;
    canvas.height = LETTERS_PX + 2 * MARGIN_PX;
    pen.font = font;
    pen.textBaseline = "middle";
    pen.lineJoin = "round";
    pen.lineWidth = MARGIN_PX * 0.8;
    pen.strokeStyle = halo;
    pen.strokeText(text, MARGIN_PX, canvas.height * 0.53);
    pen.fillStyle = color;
    pen.fillText(text, MARGIN_PX, canvas.height * 0.53);
    this.ratio = canvas.width / canvas.height;
    this.material.map?.dispose();
    this.material.map = new CanvasTexture(canvas);
    this.material.map.colorSpace = SRGBColorSpace;
    this.material.needsUpdate = true;
  }

  /** Set the height of the text in metres. */
  setHeight(metres: number): void {
    this.scale.set(metres * this.ratio, metres, 1);
  }
}

/** Red, green and blue as robot people know them, a little softer. */
export const AXIS_COLORS = [0xf2555a, 0x5fc26b, 0x4d8dff] as const;

/** The three axes of a frame as coloured bars of length 1. */
export function axesGeometry(thickness: number): BufferGeometry {
  const bars = AXIS_COLORS.map((color, axis) => {
    const bar = new CylinderGeometry(thickness, thickness, 1, 8);
    bar.translate(0, 0.5, 0);
    if (axis === 0) {
      bar.rotateZ(-Math.PI / 2);
    } else if (axis === 2) {
      bar.rotateX(Math.PI / 2);
    }
    const { r, g, b } = new Color(color);
    const count = bar.getAttribute("position").count;
    bar.setAttribute("color", new Float32BufferAttribute(Array.from({ length: count }, () => [r, g, b]).flat(), 3));
    return bar;
  });
  const axes = mergeGeometries(bars);
  for (const bar of bars) {
    bar.dispose();
  }
  return axes;
}
