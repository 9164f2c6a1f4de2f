// Map: occupancy grids and costmaps as textures on the ground.
import {
  Box3,
  DataTexture,
  LinearMipmapLinearFilter,
  Mesh,
  NearestFilter,
  NearestMipmapNearestFilter,
  PlaneGeometry,
  RGBAFormat,
  ShaderMaterial,
  UnsignedByteType,
} from "three";
import type { OccupancyGridUpdate } from "../../generated/map_msgs";
import type { OccupancyGrid } from "../../generated/nav_msgs";
import { costmapPalette, mapPalette, rawPalette, type Palette } from "../../scene/colors";
import { beginsFine } from "../../scene/graphics";
import { Layer } from "../../scene/layers";
import type { Settings } from "../../contract";
import type { DisplayContext, BuiltInDisplay, FrameInfo } from "../display";
import { number, text } from "../settings";
import { StampedDisplay } from "../topic_display";

const LARGEST_TEXTURE = 8192;

// Colours go from the palette to the screen as they are: maps fill it, and every conversion would cost.
const VERTEX = /* glsl */ `
  varying vec2 at;
  void main() {
    at = uv;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  }`;
const FRAGMENT = /* glsl */ `
  uniform sampler2D cells;
  uniform float alpha;
  varying vec2 at;
  void main() {
    gl_FragColor = texture2D(cells, at) * vec4(1.0, 1.0, 1.0, alpha);
  }`;

export class MapDisplay extends StampedDisplay<OccupancyGrid> {
  private readonly uniforms = { cells: { value: null as DataTexture | null }, alpha: { value: 1 } };
  private readonly mesh = new Mesh(
    new PlaneGeometry(1, 1).translate(0.5, 0.5, 0),
    new ShaderMaterial({
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      uniforms: this.uniforms,
      transparent: true,
      depthWrite: false,
    }),
  );
  private readonly stopUpdates: () => void;
  private texture: DataTexture | undefined;
  private pixels = new Uint32Array();
  private painted: string | undefined;
  private error = "";

  constructor(context: DisplayContext, settings: Settings) {
    super(context, settings, "latest");
    this.object.add(this.mesh);
    const updates = `${text(settings, "topic")}_updates`;
    this.stopUpdates = text(settings, "topic")
      ? context.session.subscribe<OccupancyGridUpdate>(updates, 32, (update) => this.patch(update))
      : () => undefined;
  }

  /** Width and height in cells of what is shown. */
  get size(): [number, number] {
    return this.shown ? [this.shown.info.width, this.shown.info.height] : [0, 0];
  }

  protected override show(grid: OccupancyGrid): void {
    const { width, height, resolution, origin } = grid.info;
    this.error = errorIn(grid);
    if (this.error) {
      return;
    }
    if (!this.texture || this.texture.image.width !== width || this.texture.image.height !== height) {
      this.makeTexture(width, height);
    }
    this.paint(grid, 0, 0, width, height, grid.data);
    const { position, orientation } = origin;
    this.mesh.position.set(position.x, position.y, position.z);
    this.mesh.quaternion.set(orientation.x, orientation.y, orientation.z, orientation.w).normalize();
    this.mesh.scale.set(width * resolution, height * resolution, 1);
    this.style();
  }

  override update(frame: FrameInfo): void {
    super.update(frame);
    if (this.shown && this.painted !== this.scheme()) {
      this.show(this.shown);
    }
    if (this.error) {
      this.report("error", this.error);
    }
  }

  override bounds(): Box3 {
    return this.shown && this.object.visible ? new Box3().setFromObject(this.mesh) : new Box3();
  }

  override dispose(): void {
    this.stopUpdates();
    this.texture?.dispose();
    super.dispose();
  }

  protected override describe({ info }: OccupancyGrid): string {
    return `${info.width} × ${info.height} cells of ${Number(info.resolution.toFixed(3))} m`;
  }

  private patch(update: OccupancyGridUpdate): void {
    const grid = this.shown;
    const { x, y, width, height, data } = update;
    if (!grid || x < 0 || y < 0 || x + width > grid.info.width || y + height > grid.info.height) {
      return;
    }
    for (let row = 0; row < height; row++) {
      grid.data.set(data.subarray(row * width, (row + 1) * width), (y + row) * grid.info.width + x);
    }
    this.paint(grid, x, y, width, height, data);
    this.context.invalidate();
  }

  private makeTexture(width: number, height: number): void {
    this.texture?.dispose();
    this.pixels = new Uint32Array(width * height);
    const bytes = new Uint8Array(this.pixels.buffer);
    this.texture = new DataTexture(bytes, width, height, RGBAFormat, UnsignedByteType);
    // Cells stay sharp from near, and do not shimmer from afar.
    this.texture.magFilter = NearestFilter;
    this.texture.minFilter = beginsFine ? LinearMipmapLinearFilter : NearestMipmapNearestFilter;
    this.texture.generateMipmaps = true;
    this.texture.anisotropy = beginsFine ? 4 : 1;
    this.uniforms.cells.value = this.texture;
  }

  private paint(grid: OccupancyGrid, x: number, y: number, width: number, height: number, data: Int8Array): void {
    this.painted = this.scheme();
    const palette = new Uint32Array(paletteFor(this.painted).buffer);
    for (let row = 0; row < height; row++) {
      let to = (y + row) * grid.info.width + x;
      for (let from = row * width; from < (row + 1) * width; from++, to++) {
        this.pixels[to] = palette[(data[from] as number) & 255] as number;
      }
    }
    if (this.texture) {
      this.texture.needsUpdate = true;
    }
  }

  private scheme(): string {
    return text(this.settings, "scheme");
  }

  private style(): void {
    const behind = text(this.settings, "layer") === "behind";
    const costs = this.scheme() === "costmap";
    this.mesh.renderOrder = behind ? Layer.BEHIND : costs ? Layer.COSTMAP : Layer.MAP;
    this.uniforms.alpha.value = number(this.settings, "alpha");
  }
}

function errorIn({ info, data }: OccupancyGrid): string {
  if (info.width * info.height !== data.length) {
    return `${data.length} cells do not fill ${info.width} × ${info.height}`;
  }
  if (Math.max(info.width, info.height) > LARGEST_TEXTURE) {
    return `${info.width} × ${info.height} cells are more than a texture can hold`;
  }
  return info.width * info.height === 0 ? "the map is empty" : "";
}

function paletteFor(scheme: string): Palette {
  switch (scheme) {
    case "costmap":
      return costmapPalette();
    case "raw":
      return rawPalette();
  }
  return mapPalette();
}

export default {
  id: "Map",
  icon: "map",
  discovery: "appears",
  messages: ["nav_msgs/msg/OccupancyGrid"],
  properties: [
    { key: "topic", label: "Topic", kind: "topic" },
    {
      key: "scheme",
      label: "Colour scheme",
      kind: "choice",
      options: [
        ["map", "map"],
        ["costmap", "costmap"],
        ["raw", "raw"],
      ],
    },
    { key: "alpha", label: "Alpha", kind: "number", min: 0, max: 1, step: 0.05 },
    {
      key: "layer",
      label: "Draw",
      kind: "choice",
      options: [
        ["normal", "in order"],
        ["behind", "behind all"],
      ],
    },
  ],
  defaults: { topic: "/map", scheme: "map", alpha: 1, layer: "normal" },
  legend: ({ scheme }) => (scheme === "costmap" ? "#f47060" : "var(--text)"),
  create: (context, settings) => new MapDisplay(context, settings),
} satisfies BuiltInDisplay;
