// The simulated world: models by their shapes, in the world frame.
import { signal } from "@preact/signals";
import {
  Box3,
  BoxGeometry,
  EdgesGeometry,
  Group,
  LineBasicMaterial,
  LineSegments,
  Matrix4,
  type Mesh,
  type Object3D,
  Quaternion,
  Vector3,
} from "three";
import { disposeTree, type DisplayContext } from "../../displays/display";
import GRID from "../../displays/types/grid";
import { markerObject } from "../../displays/marker_shapes";
import type { Pose } from "../../generated/geometry_msgs";
import type { Marker } from "../../generated/visualization_msgs";
import { FirstView } from "../../scene/first_view";
import type { Content } from "../../scene/framing";
import { DAYLIGHT } from "../../scene/looks";
import { RobotPin } from "../../scene/robot_pin";
import { Viewport } from "../../scene/viewport";
import type { GetShapes_Response, ModelParts } from "../../generated/daidalos_msgs";
import { entityTree, splitEntity, type Entity } from "./entity_tree";
import type { EntityStates } from "./simulator";

/** A flatter and larger shape is the ground, which the grid represents. */
const GROUND_M2 = 100;
const GROUND_THICKNESS_M = 0.05;
/** A link that moves less than this, in metres and as a quaternion, is not drawn again. */
const STILL = 1e-5;
const FRAME_COLOR = 0xe2a355;
const GHOST_OPACITY = 0.45;

interface Shown {
  name: string;
  /** Holds the links; moved only while the user drags the model. */
  holder: Group;
  links: Map<string, Group>;
  /** The markers that it was made of, as JSON. */
  source: string;
  /** Where it was when the user began to drag it; until the end of the drag, poses from the simulator are not shown. */
  dragged?: { pose: Pose; bottom: number } | undefined;
}

export class Stage {
  readonly viewport: Viewport;
  readonly selected = signal("");
  readonly names = signal<readonly string[]>([]);
  /** Models with their links, joints and sensors. */
  readonly entities = signal<readonly Entity[]>([]);
  /** The pose of the selected model. */
  readonly reading = signal<Pose | undefined>(undefined);
  private readonly models = new Map<string, Shown>();
  private readonly poses = new Map<string, Pose>();
  private readonly frame = new LineSegments(
    new EdgesGeometry(new BoxGeometry()),
    new LineBasicMaterial({ color: FRAME_COLOR }),
  );
  private parts: readonly ModelParts[] = [];
  private ghost: Object3D | undefined;
  /** Of the selected model. */
  radius = 0;
  private readonly first: FirstView;
  private readonly pin: RobotPin;
  private isFramed = false;

  constructor(
    container: HTMLElement,
    private readonly context: Omit<DisplayContext, "invalidate">,
  ) {
    this.viewport = new Viewport(container);
    this.first = new FirstView(this.viewport.view, () => this.content());
    this.pin = new RobotPin(container, this.viewport);
    const grid = GRID.create({ ...context, invalidate: this.viewport.invalidate }, GRID.defaults);
    this.viewport.look = DAYLIGHT;
    this.frame.visible = false;
    this.frame.matrixAutoUpdate = false;
    this.viewport.scene.add(grid.object, this.frame);
  }

  /** Show the simulator's models. */
  show({ shapes, entities, poses, models: parts }: GetShapes_Response): void {
    const models = new Map<string, Marker[]>();
    for (const name of entities.filter((each) => !each.includes("::"))) {
      models.set(name, []);
    }
    for (const shape of shapes) {
      models.get(shape.ns)?.push(shape);
    }
    for (const [name, shown] of this.models) {
      if (!models.has(name)) {
        this.drop(shown);
      }
    }
    for (const [name, markers] of models) {
      const source = JSON.stringify(markers);
      const before = this.models.get(name);
      if (before?.source !== source) {
        if (before) {
          this.drop(before);
        }
        this.models.set(name, this.make(name, markers, source));
      }
    }
    this.names.value = [...models.keys()];
    this.parts = parts;
    this.entities.value = entityTree(entities, parts);
    if (!models.has(this.selected.value)) {
      this.select("");
    }
    this.place({ name: entities, pose: poses });
  }

  /** Set the poses of links; false where there are unknown ones. */
  place({ name: names, pose: poses }: EntityStates): boolean {
    let known = true;
    const seen = new Set<string>();
    names.forEach((name, i) => {
      const pose = poses[i] as Pose;
      const { model, link } = splitEntity(name);
      const shown = this.models.get(model);
      seen.add(model);
      known &&= shown !== undefined;
      this.poses.set(name, pose);
      const group = link === undefined ? undefined : shown?.links.get(link);
      if (group && !shown?.dragged && put(group, pose)) {
        this.touch();
      }
      // Also for the dragged model, whose last pose here may differ from the simulator's.
      const read = name === this.selected.value ? this.reading.value : undefined;
      if (read && isElsewhere(read, pose)) {
        this.touch();
      }
    });
    return known && seen.size === this.models.size;
  }

  select(name: string): void {
    this.selected.value = name;
    this.touch();
  }

  /** Centre the view on a model or a link. */
  focusOn(entity: string): void {
    const centre = this.centreOf(entity);
    if (centre) {
      this.viewport.view.lookAt(centre);
    }
  }

  /** The centre of what is drawn of a model or a link; of the model where there is no such link. */
  centreOf(entity: string): Vector3 | undefined {
    const { model, link } = splitEntity(entity);
    const shown = this.models.get(model);
    const box = shown ? new Box3().setFromObject((link && shown.links.get(link)) || shown.holder) : new Box3();
    return box.isEmpty() ? undefined : box.getCenter(new Vector3());
  }

  /** The last pose of a model from the simulator. */
  poseOf(name: string): Pose | undefined {
    return this.poses.get(name);
  }

  /** The types of a model's shapes, and the number of its links. */
  anatomy(name: string): { types: readonly number[]; links: number } {
    const shown = this.models.get(name);
    const markers = shown ? (JSON.parse(shown.source) as Marker[]) : [];
    return { types: markers.map(({ type }) => type), links: shown?.links.size ?? 0 };
  }

  /** The model under a pixel, and where it is hit. */
  pick(x: number, y: number): { name: string; point: Vector3 } | undefined {
    const hit = this.viewport.hitAt(x, y);
    for (let object: Object3D | null = hit?.object ?? null; hit && object; object = object.parent) {
      if (typeof object.userData.model === "string") {
        return { name: object.userData.model, point: hit.point };
      }
    }
    return undefined;
  }

  /** Where a model was when the user began to drag it. */
  dragStart(name: string): Pose | undefined {
    return this.models.get(name)?.dragged?.pose;
  }

  /** Start to drag a model: until `release`, only `preview` moves it. */
  startDrag(name: string): void {
    const shown = this.models.get(name);
    const pose = this.poses.get(name);
    if (shown && pose) {
      shown.dragged = { pose, bottom: new Box3().setFromObject(shown.holder).min.z };
      shown.holder.matrixAutoUpdate = false;
    }
  }

  /** Show a dragged model at an offset from where it was. */
  preview(name: string, motion: Matrix4): void {
    const shown = this.models.get(name);
    if (shown?.dragged) {
      shown.holder.matrix.copy(motion);
      shown.holder.matrixWorldNeedsUpdate = true;
      this.touch();
    }
  }

  /** The matrix that scales a dragged model along its axes and keeps its lowest point on the ground. */
  growth(name: string, factors: Vector3): Matrix4 {
    const dragged = this.models.get(name)?.dragged;
    if (!dragged) {
      return new Matrix4();
    }
    const there = matrixOf(dragged.pose);
    const grown = there.clone().scale(factors).multiply(there.invert());
    const { position } = dragged.pose;
    const origin = new Vector3(position.x, position.y, position.z);
    const lift = (origin.z - dragged.bottom) * (this.verticalFactor(dragged.pose, factors) - 1);
    return new Matrix4().makeTranslation(0, 0, lift).multiply(grown);
  }

  /** End the drag: the model has the simulator's pose again. */
  release(name: string): void {
    const shown = this.models.get(name);
    if (shown) {
      shown.dragged = undefined;
      shown.holder.matrixAutoUpdate = true;
      this.touch();
    }
  }

  /** Show a placeholder of the model to insert; undefined: none. */
  showGhost(marker: Marker | undefined, at?: Vector3): void {
    if (this.ghost) {
      disposeTree(this.ghost);
      this.ghost.removeFromParent();
      this.ghost = undefined;
    }
    if (marker && at) {
      this.ghost = this.objectOf({ ...marker, color: { ...marker.color, a: GHOST_OPACITY } });
      this.ghost?.traverse((object) => (object.userData.pickable = false));
      this.ghost?.position.add(at);
      if (this.ghost) {
        this.viewport.scene.add(this.ghost);
      }
    }
    this.viewport.invalidate();
  }

  draw(page: number): void {
    if (!this.isFramed) {
      this.isFramed = true;
      this.drawFrame();
      this.reading.value = this.models.has(this.selected.value) ? this.poses.get(this.selected.value) : undefined;
    }
    const { view } = this.viewport;
    this.first.update(page, this.viewport.aspect);
    this.viewport.lights.follow(view.focus, view.reach);
    this.viewport.frame(page);
    const robot = this.robot();
    this.pin.update(boxOf(robot), robot?.name ?? "");
  }

  dispose(): void {
    this.pin.dispose();
    for (const shown of this.models.values()) {
      this.drop(shown);
    }
    this.viewport.dispose();
  }

  /** Draw again, with the box around the selected model. */
  private readonly touch = (): void => {
    this.isFramed = false;
    this.viewport.invalidate();
  };

  /** A box along the selected model's own axes. */
  private drawFrame(): void {
    const shown = this.models.get(this.selected.value);
    const pose = shown?.dragged?.pose ?? this.poses.get(this.selected.value);
    const box = shown && pose ? boxAlong(matrixOf(pose), shown.links.values()) : new Box3();
    this.frame.visible = !box.isEmpty();
    this.radius = this.frame.visible ? box.getSize(new Vector3()).length() / 2 : 0;
    if (shown && pose && this.frame.visible) {
      shown.holder.updateMatrix();
      const size = box.getSize(new Vector3()).addScalar(FRAME_MARGIN_M);
      this.frame.matrix
        .copy(shown.holder.matrix)
        .multiply(matrixOf(pose))
        .multiply(new Matrix4().makeTranslation(box.getCenter(new Vector3())))
        .scale(size);
      this.frame.matrixWorldNeedsUpdate = true;
    }
  }

  /** The factor by which the distance to the ground changes. */
  private verticalFactor({ orientation: { x, y, z, w } }: Pose, factors: Vector3): number {
    const down = UP.clone().applyQuaternion(new Quaternion(x, y, z, w).invert());
    return down.multiply(factors).length();
  }

  private objectOf(marker: Marker): Object3D | undefined {
    return markerObject(marker, {
      assets: this.context.assets,
      dark: true,
      changed: this.touch,
      onError: () => undefined, // a mesh that cannot be read: the rest is shown
    });
  }

  private make(name: string, markers: Marker[], source: string): Shown {
    const shown: Shown = { name, holder: new Group(), links: new Map(), source };
    shown.holder.userData.model = name;
    for (const marker of markers) {
      if (isGround(marker)) {
        continue;
      }
      const link = splitEntity(marker.header.frame_id).link ?? "";
      const group = shown.links.get(link) ?? new Group();
      const object = this.objectOf(marker);
      if (object) {
        group.add(object);
      }
      shown.links.set(link, group);
      shown.holder.add(group);
    }
    this.viewport.scene.add(shown.holder);
    return shown;
  }

  private drop(shown: Shown): void {
    disposeTree(shown.holder);
    shown.holder.removeFromParent();
    this.models.delete(shown.name);
    this.touch();
  }

  /** The box around all models, and around the robot. */
  private content(): Content {
    const all = new Box3();
    for (const shown of this.models.values()) {
      all.union(boxOf(shown));
    }
    if (all.isEmpty() && this.models.size) {
      all.copy(BARE_WORLD);
    }
    return {
      all,
      robot: boxOf(this.robot()),
      sees: (from, to, within) => this.viewport.sees(from, to, within),
    };
  }

  /** The first model that can move and has joints. */
  private robot(): Shown | undefined {
    const robot = this.parts.find(({ is_static, joints }) => !is_static && joints.length > 0);
    return robot && this.models.get(robot.name);
  }
}

function boxOf(shown: Shown | undefined): Box3 {
  return shown ? new Box3().setFromObject(shown.holder) : new Box3();
}

/** What is shown of a world that has nothing but its ground. */
const BARE_WORLD = new Box3(new Vector3(-1.5, -1.5, 0), new Vector3(1.5, 1.5, 0));
const UP = new Vector3(0, 0, 1);
const FRAME_MARGIN_M = 0.01;

function isGround({ scale }: Marker): boolean {
  return scale.z < GROUND_THICKNESS_M && scale.x * scale.y > GROUND_M2;
}

/** Set an object's pose; false where it has it already. */
function put(object: Object3D, pose: Pose): boolean {
  const { position: p, orientation: o } = pose;
  if (!isElsewhere({ position: object.position, orientation: object.quaternion }, pose)) {
    return false;
  }
  object.position.set(p.x, p.y, p.z);
  object.quaternion.set(o.x, o.y, o.z, o.w);
  return true;
}

/** Whether two poses differ by more than the jitter of a model at rest. */
function isElsewhere({ position: at, orientation: turn }: Pose, { position: p, orientation: o }: Pose): boolean {
  const by = Math.max(Math.abs(at.x - p.x), Math.abs(at.y - p.y), Math.abs(at.z - p.z));
  const turned = Math.max(Math.abs(turn.x - o.x), Math.abs(turn.y - o.y), Math.abs(turn.z - o.z));
  return by >= STILL || turned >= STILL;
}

export function matrixOf({ position: p, orientation: o }: Pose): Matrix4 {
  const turn = new Quaternion(o.x, o.y, o.z, o.w);
  return new Matrix4().compose(new Vector3(p.x, p.y, p.z), turn, new Vector3(1, 1, 1));
}

/** A pose after a motion in the world frame. */
export function movedPose(pose: Pose, motion: Matrix4): Pose {
  const [position, orientation] = [new Vector3(), new Quaternion()];
  motion.clone().multiply(matrixOf(pose)).decompose(position, orientation, new Vector3());
  const { x, y, z, w } = orientation;
  return { position: { x: position.x, y: position.y, z: position.z }, orientation: { x, y, z, w } };
}

/** The box around objects along the axes of a pose, in that pose. */
function boxAlong(pose: Matrix4, links: Iterable<Group>): Box3 {
  const box = new Box3();
  const toPose = pose.clone().invert();
  const path = new Matrix4();
  const add = (object: Object3D, from: Matrix4) => {
    object.updateMatrix();
    const here = from.clone().multiply(object.matrix);
    const { geometry } = object as Partial<Mesh>;
    if (geometry) {
      geometry.computeBoundingBox();
      box.union((geometry.boundingBox as Box3).clone().applyMatrix4(path.multiplyMatrices(toPose, here)));
    }
    object.children.forEach((child) => add(child, here));
  };
  for (const link of links) {
    add(link, new Matrix4());
  }
  return box;
}
