// Points as round dots: sized in metres or in pixels, coloured one by one.
import {
  Box3,
  BufferAttribute,
  BufferGeometry,
  DynamicDrawUsage,
  Points,
  ShaderMaterial,
  Vector2,
  Vector3,
  type WebGLRenderer,
} from "three";

const VERTEX = /* glsl */ `
  attribute vec3 color;
  uniform float metres;
  uniform float pixels;
  uniform float height;
  varying vec3 tint;
  void main() {
    tint = color;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
    float projected = metres * projectionMatrix[1][1] * 0.5 * height / gl_Position.w;
    gl_PointSize = max(pixels, projected);
  }`;

const FRAGMENT = /* glsl */ `
  uniform float alpha;
  uniform bool round;
  varying vec3 tint;
  void main() {
    vec2 from = gl_PointCoord - 0.5;
    if (round && dot(from, from) > 0.25) discard;
    gl_FragColor = vec4(tint, alpha);
  }`;

/** A box around more points than that is taken from as many of them. */
const MAX_SAMPLES = 2000;
const BUFFER_SIZE = new Vector2();

export interface PointStyle {
  /** Diameter in metres; at least so many pixels. */
  metres: number;
  pixels: number;
  round: boolean;
  alpha: number;
}

export class PointSprites extends Points<BufferGeometry, ShaderMaterial> {
  private room = 0;

  constructor() {
    super(
      new BufferGeometry(),
      new ShaderMaterial({
        vertexShader: VERTEX,
        fragmentShader: FRAGMENT,
        uniforms: {
          metres: { value: 0 },
          pixels: { value: 3 },
          height: { value: 1 },
          alpha: { value: 1 },
          round: { value: true },
        },
      }),
    );
    this.frustumCulled = false;
    this.onBeforeRender = (renderer) => {
      this.uniform("height", (renderer as WebGLRenderer).getDrawingBufferSize(BUFFER_SIZE).y);
    };
  }

  set style({ metres, pixels, round, alpha }: PointStyle) {
    this.uniform("metres", metres);
    this.uniform("pixels", pixels);
    this.uniform("round", round);
    this.uniform("alpha", alpha);
    this.material.transparent = alpha < 1;
    this.material.depthWrite = alpha >= 1;
  }

  get shown(): number {
    return this.geometry.drawRange.count === Infinity ? 0 : this.geometry.drawRange.count;
  }

  /** Make room for so many points and return where to write them: x y z and r g b, one after another. */
  begin(count: number): { positions: Float32Array; colors: Uint8Array } {
    if (count > this.room) {
      this.room = Math.ceil(count * 1.25) + 64;
      this.geometry.dispose();
      this.geometry = new BufferGeometry();
      const positions = new BufferAttribute(new Float32Array(3 * this.room), 3);
      const colors = new BufferAttribute(new Uint8Array(3 * this.room), 3, true);
      this.geometry.setAttribute("position", positions.setUsage(DynamicDrawUsage));
      this.geometry.setAttribute("color", colors.setUsage(DynamicDrawUsage));
      this.geometry.setDrawRange(0, 0);
    }
    if (this.room === 0) {
      return { positions: new Float32Array(), colors: new Uint8Array() };
    }
    return {
      positions: this.geometry.getAttribute("position").array as Float32Array,
      colors: this.geometry.getAttribute("color").array as Uint8Array,
    };
  }

  /** Show the first so many of what was written. */
  end(count: number): void {
    this.geometry.setDrawRange(0, count);
    for (const name of ["position", "color"] as const) {
      const attribute = this.geometry.getAttribute(name) as BufferAttribute | undefined;
      if (attribute) {
        attribute.clearUpdateRanges();
        attribute.addUpdateRange(0, 3 * count);
        attribute.needsUpdate = true;
      }
    }
  }

  /** The box around what is shown, in the scene. */
  bounds(): Box3 {
    const box = new Box3();
    const positions = this.geometry.getAttribute("position") as BufferAttribute | undefined;
    const point = new Vector3();
    const step = Math.max(1, Math.floor(this.shown / MAX_SAMPLES));
    this.updateWorldMatrix(true, false);
    for (let i = 0; positions && i < this.shown; i += step) {
      box.expandByPoint(point.fromBufferAttribute(positions, i).applyMatrix4(this.matrixWorld));
    }
    return box;
  }

  private uniform(name: string, value: number | boolean): void {
    const uniform = this.material.uniforms[name];
    if (uniform) {
      uniform.value = value;
    }
  }
}
