// The shapes of visualization_msgs/Marker as objects of the scene.
import {
  BoxGeometry,
  BufferGeometry,
  Color,
  CylinderGeometry,
  Float32BufferAttribute,
  Group,
  InstancedMesh,
  LineBasicMaterial,
  LineSegments,
  Matrix4,
  Mesh,
  MeshStandardMaterial,
  Quaternion,
  SphereGeometry,
  SRGBColorSpace,
  Vector3,
  type Material,
  type Object3D,
} from "three";
import { LineMaterial } from "three/examples/jsm/lines/LineMaterial.js";
import { LineSegments2 } from "three/examples/jsm/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/examples/jsm/lines/LineSegmentsGeometry.js";
import type { ColorRGBA } from "../generated/std_msgs";
import { Marker } from "../generated/visualization_msgs";
import type { Assets } from "../scene/assets";
import { wrapBox, wrapRound } from "../scene/wrapping";
import { PointSprites } from "../scene/point_sprites";
import { setShadowing } from "../scene/shadowing";
import { arrowGeometry, Label } from "../scene/shapes";
import { setVeiled } from "../scene/veil";

export interface MarkerContext {
  assets: Assets;
  dark: boolean;
  changed: () => void;
  onError: (text: string) => void;
}

/** Build a marker's object at its pose within its frame; undefined for types that are not known. */
export function markerObject(marker: Marker, context: MarkerContext): Object3D | undefined {
  const shape = shapeOf(marker, context);
  if (shape) {
    const { position, orientation } = marker.pose;
    shape.position.set(position.x, position.y, position.z);
    const { x, y, z, w } = orientation;
    // A quaternion of zeros is a common slip; every viewer takes it for no rotation.
    shape.quaternion.set(x, y, z, x || y || z || w ? w : 1).normalize();
  }
  return shape;
}

function shapeOf(marker: Marker, context: MarkerContext): Object3D | undefined {
  const { scale } = marker;
  switch (marker.type) {
    case Marker.ARROW:
      return arrow(marker);
    case Marker.CUBE:
      return sized(new BoxGeometry(), marker, context);
    case Marker.SPHERE:
      return sized(new SphereGeometry(0.5, 32, 20).rotateX(Math.PI / 2), marker, context);
    case Marker.CYLINDER:
      return sized(new CylinderGeometry(0.5, 0.5, 1, 32).rotateX(Math.PI / 2), marker, context);
    case Marker.LINE_STRIP:
    case Marker.LINE_LIST:
      return lines(marker);
    case Marker.CUBE_LIST:
      return many(new BoxGeometry(scale.x, scale.y, scale.z), marker);
    case Marker.SPHERE_LIST:
      return many(new SphereGeometry(0.5, 16, 10).scale(scale.x, scale.y, scale.z), marker);
    case Marker.POINTS:
      return points(marker);
    case Marker.TEXT_VIEW_FACING:
      return label(marker, context.dark);
    case Marker.MESH_RESOURCE:
      return mesh(marker, context);
    case Marker.TRIANGLE_LIST:
      return triangles(marker);
  }
  return undefined;
}

/** A shape of unit size with the marker's scale and texture. */
function sized(geometry: BufferGeometry, marker: Marker, { assets, changed, onError }: MarkerContext): Mesh {
  const { type, scale, texture_resource: image } = marker;
  if (image) {
    (type === Marker.CUBE ? wrapBox : wrapRound)(geometry);
  }
  const object = solid(geometry.scale(scale.x, scale.y, scale.z), marker);
  const { material: look } = object;
  if (image) {
    assets
      .texture(image)
      .then((texture) => {
        look.map = texture;
        look.needsUpdate = true;
        changed();
      })
      .catch((error: Error) => onError(error.message));
  }
  return object;
}

function solid(geometry: BufferGeometry, marker: Marker): Mesh<BufferGeometry, MeshStandardMaterial> {
  const object = new Mesh(geometry, material(marker.color));
  setShadowing(object, marker.color.a >= 1);
  object.userData.pickable = true;
  setVeiled(object, marker.color.a < 1);
  return object;
}

function arrow(marker: Marker): Object3D {
  const { scale, points: ends } = marker;
  const [from, to] = ends;
  if (!from || !to) {
    // Scale: length, width and height, as RViz divides them between shaft and head.
    const geometry = arrowGeometry({
      shaftLength: 0.77 * scale.x,
      shaftRadius: 0.5,
      headLength: 0.23 * scale.x,
      headRadius: 1,
    }).scale(1, scale.y / 2, scale.z / 2);
    return solid(geometry, marker);
  }
  // Scale: shaft diameter, head diameter, head length (0: a share of the whole).
  const along = new Vector3(to.x - from.x, to.y - from.y, to.z - from.z);
  const length = along.length();
  const headLength = Math.min(length, scale.z || 0.23 * length);
  const object = solid(
    arrowGeometry({
      shaftLength: length - headLength,
      shaftRadius: scale.x / 2,
      headLength,
      headRadius: scale.y / 2,
    }),
    marker,
  );
  object.position.set(from.x, from.y, from.z);
  object.quaternion.setFromUnitVectors(new Vector3(1, 0, 0), along.normalize());
  return new Group().add(object);
}

function lines(marker: Marker): Object3D {
  const strip = marker.type === Marker.LINE_STRIP;
  const { points: ends, colors } = marker;
  const positions: number[] = [];
  const tints: number[] = [];
  const step = strip ? 1 : 2;
  for (let i = 0; i + 1 < ends.length; i += step) {
    for (const at of [i, i + 1]) {
      const point = ends[at];
      if (point) {
        positions.push(point.x, point.y, point.z);
        tints.push(...linear(colors[at] ?? marker.color));
      }
    }
  }
  if (positions.length === 0) {
    return new LineSegments(new BufferGeometry(), new LineBasicMaterial());
  }
  const geometry = new LineSegmentsGeometry().setPositions(positions).setColors(tints);
  const style = new LineMaterial({
    vertexColors: true,
    worldUnits: true,
    linewidth: marker.scale.x,
    transparent: opacityOf(marker) < 1,
    opacity: opacityOf(marker),
  });
  return new LineSegments2(geometry, style);
}

/** The marker's opacity; where each point has a color and the marker none, that of the first point, as in RViz. */
function opacityOf({ color, colors }: Marker): number {
  return color.a || (colors[0]?.a ?? 0);
}

function many(geometry: BufferGeometry, marker: Marker): Object3D {
  const object = new InstancedMesh(
    geometry,
    material({ ...marker.color, a: opacityOf(marker) }),
    Math.max(1, marker.points.length),
  );
  const [matrix, color] = [new Matrix4(), new Color()];
  marker.points.forEach(({ x, y, z }, i) => {
    object.setMatrixAt(i, matrix.compose(new Vector3(x, y, z), new Quaternion(), new Vector3(1, 1, 1)));
    const own = marker.colors[i];
    if (own) {
      object.setColorAt(i, color.setRGB(own.r, own.g, own.b, SRGBColorSpace));
    }
  });
  if (marker.colors.length) {
    (object.material as MeshStandardMaterial).color.set(0xffffff);
  }
  object.count = marker.points.length;
  object.frustumCulled = false;
  return object;
}

function points(marker: Marker): Object3D {
  const sprites = new PointSprites();
  const { positions, colors } = sprites.begin(marker.points.length);
  marker.points.forEach(({ x, y, z }, i) => {
    positions.set([x, y, z], 3 * i);
    const { r, g, b } = marker.colors[i] ?? marker.color;
    colors.set([255 * r, 255 * g, 255 * b], 3 * i);
  });
  sprites.style = { metres: marker.scale.x, pixels: 1, round: false, alpha: marker.color.a || 1 };
  sprites.end(marker.points.length);
  return sprites;
}

function label(marker: Marker, dark: boolean): Object3D {
  const { r, g, b } = marker.color;
  const color = `rgb(${255 * r} ${255 * g} ${255 * b})`;
  const object = new Label(marker.text, color, dark ? "#0d1117" : "#f4f6f9");
  object.center.set(0.5, 0.5);
  object.setHeight(marker.scale.z * 1.4);
  return object;
}

function mesh(marker: Marker, { assets, changed, onError }: MarkerContext): Object3D {
  const holder = new Group();
  holder.scale.set(marker.scale.x, marker.scale.y, marker.scale.z);
  assets
    .load(marker.mesh_resource)
    .then((model) => {
      model.traverse((object) => {
        object.userData.pickable = object instanceof Mesh;
        setShadowing(object, object instanceof Mesh && marker.color.a >= 1);
        if (object instanceof Mesh && !marker.mesh_use_embedded_materials) {
          object.material = material(marker.color);
        }
      });
      holder.add(model);
      changed();
    })
    .catch((error: Error) => onError(error.message));
  return holder;
}

function triangles(marker: Marker): Object3D {
  const corners = marker.points.length - (marker.points.length % 3);
  const geometry = new BufferGeometry();
  const positions = marker.points
    .slice(0, corners)
    .flatMap(({ x, y, z }) => [x * marker.scale.x, y * marker.scale.y, z * marker.scale.z]);
  geometry.setAttribute("position", new Float32BufferAttribute(positions, 3));
  // One colour for each corner, or for each triangle.
  const each = marker.colors.length * 3 === corners ? 3 : 1;
  const painted = marker.colors.length * each >= corners && corners > 0;
  if (painted) {
    const tints = Array.from({ length: corners }, (_, i) =>
      linear(marker.colors[Math.floor(i / each)] as ColorRGBA),
    ).flat();
    geometry.setAttribute("color", new Float32BufferAttribute(tints, 3));
  }
  geometry.computeVertexNormals();
  const style = material(painted ? { r: 1, g: 1, b: 1, a: marker.color.a || 1 } : marker.color);
  style.vertexColors = painted;
  style.side = 2;
  const object = new Mesh(geometry, style as Material);
  setShadowing(object, marker.color.a >= 1);
  object.userData.pickable = true;
  return object;
}

function material({ r, g, b, a }: ColorRGBA): MeshStandardMaterial {
  return new MeshStandardMaterial({
    color: new Color().setRGB(r, g, b, SRGBColorSpace),
    opacity: a,
    transparent: a < 1,
    depthWrite: a >= 1,
    roughness: 0.7,
  });
}

function linear({ r, g, b }: ColorRGBA): [number, number, number] {
  const color = new Color().setRGB(r, g, b, SRGBColorSpace);
  return [color.r, color.g, color.b];
}
