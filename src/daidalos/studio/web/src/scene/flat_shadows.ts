// Shadows for software renderers: bodies drawn a second time, pressed flat on the ground along the sun's rays.
//
// Where a map of what the sun sees costs a look-up for every pixel of the ground, these cost the pixels that are dark.
import {
  Color,
  DoubleSide,
  EqualStencilFunc,
  IncrementStencilOp,
  ShaderMaterial,
  type Camera,
  type ColorRepresentation,
  type Scene,
  type Vector3,
  type WebGLRenderer,
} from "three";

/** The layer of what casts shadows, beside the one that everything is in. */
export const CASTERS = 1;

const VERTEX = `
  uniform vec3 sun;
  varying float height;
  void main() {
    vec4 at = modelMatrix * vec4(position, 1.0);
    height = at.z;
    at.xy -= sun.xy * max(at.z - GROUND, 0.0) / sun.z;
    at.z = GROUND;
    gl_Position = projectionMatrix * viewMatrix * at;
  }`;

/** What lies on the ground, such as the ground itself, has no shadow. */
const FRAGMENT = `
  uniform vec4 shade;
  varying float height;
  void main() {
    if (height < 2.0 * GROUND) discard;
    gl_FragColor = shade;
  }`;

export class FlatShadows {
  on = false;
  private readonly material: ShaderMaterial;
  private readonly color: Color;

  /** Cast by a sun in a direction, in a colour. */
  constructor(sun: Vector3, color: ColorRepresentation) {
    this.color = new Color(color);
    this.material = new ShaderMaterial({
      defines: { GROUND: "0.004" },
      uniforms: { sun: { value: sun }, shade: { value: [0, 0, 0, 0] } },
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      transparent: true,
      depthWrite: false,
      side: DoubleSide,
      // Each pixel once, however many surfaces lie above it.
      stencilWrite: true,
      stencilFunc: EqualStencilFunc,
      stencilRef: 0,
      stencilZPass: IncrementStencilOp,
    });
  }

  /** From 0 to 1. */
  set opacity(opacity: number) {
    const { r, g, b } = this.color;
    this.material.uniforms.shade = { value: [r, g, b, opacity] };
  }

  /** Draw the shadows into a picture of a scene. */
  draw(renderer: WebGLRenderer, scene: Scene, camera: Camera): void {
    if (!this.on) {
      return;
    }
    const layers = camera.layers.mask;
    camera.layers.set(CASTERS);
    scene.overrideMaterial = this.material;
    renderer.autoClear = false;
    renderer.render(scene, camera);
    renderer.autoClear = true;
    scene.overrideMaterial = null;
    camera.layers.mask = layers;
  }
}
