// The simulated world to look at and to take hold of: models by their shapes, in the world's own frame.
import { signal } from "@preact/signals";
import { Box3, BoxHelper, Group, type Object3D, Quaternion, Vector3 } from "three";
import { disposeTree, type DisplayContext } from "../../displays/display";
import { GRID } from "../../displays/grid";
import { markerObject } from "../../displays/marker_shapes";
import type { Marker, Pose } from "../../ros/messages";
import { HOME } from "../../scene/view";
import { Viewport } from "../../scene/viewport";
import type { EntityStates, Looks } from "./simulator";

/** Flatter and larger than these, a shape is ground: the grid stands for it. */
const GROUND_M2 = 100;
const GROUND_THICKNESS_M = 0.05;

interface Shown {
  name: string;
  /** Holds the links; moved only while the user has hold of the model. */
  holder: Group;
  links: Map<string, Group>;
  /** The looks from which it was made. */
  told: string;
  /** While the user has hold of it: what it turns and grows about. What comes from the simulator is not shown then. */
  held?: { pivot: Vector3; pose: Pose } | undefined;
}

export class Stage {
  readonly viewport: Viewport;
  readonly selected = signal("");
  readonly names = signal<readonly string[]>([]);
  private readonly models = new Map<string, Shown>();
  private readonly poses = new Map<string, Pose>();
  private readonly frame = new BoxHelper(new Group(), 0xe2a355);
  private wasSeen = false;

  constructor(
    container: HTMLElement,
    private readonly context: Omit<DisplayContext, "invalidate">,
  ) {
    this.viewport = new Viewport(container);
    const grid = GRID.create({ ...context, invalidate: this.viewport.invalidate }, GRID.defaults);
    this.frame.visible = false;
    this.viewport.scene.add(grid.object, this.frame);
  }

  /** Show what the simulator says that there is. */
  show({ shapes, entities, poses }: Looks): void {
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
      const told = JSON.stringify(markers);
      const before = this.models.get(name);
      if (before?.told !== told) {
        if (before) {
          this.drop(before);
        }
        this.models.set(name, this.make(name, markers, told));
      }
    }
    this.names.value = [...models.keys()];
    if (!models.has(this.selected.value)) {
      this.select("");
    }
    this.place({ name: entities, pose: poses });
    this.look();
  }

  /** Put links where they are; false where others than the known ones are told of. */
  place({ name: names, pose: poses }: EntityStates): boolean {
    let known = true;
    const seen = new Set<string>();
    names.forEach((name, i) => {
      const pose = poses[i] as Pose;
      const [model = "", link] = name.split("::");
      const shown = this.models.get(model);
      seen.add(model);
      known &&= shown !== undefined;
      this.poses.set(name, pose);
      const group = link === undefined ? undefined : shown?.links.get(link);
      if (group && !shown?.held) {
        put(group, pose);
      }
    });
    this.viewport.invalidate();
    return known && seen.size === this.models.size;
  }

  select(name: string): void {
    this.selected.value = name;
    this.viewport.invalidate();
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

  /** Where a model was when the user took hold of it. */
  poseAtHold(name: string): Pose | undefined {
    return this.models.get(name)?.held?.pose;
  }

  /** Take hold of a model: from now on only `preview` moves it. */
  hold(name: string): void {
    const shown = this.models.get(name);
    const pose = this.poses.get(name);
    if (shown && pose) {
      const bottom = new Box3().setFromObject(shown.holder).min.z;
      shown.held = { pose, pivot: new Vector3(pose.position.x, pose.position.y, bottom) };
    }
  }

  /** Show a held model moved, turned about its origin's vertical, and scaled where it stands. */
  preview(name: string, by: Vector3, yaw: number, factor: number): void {
    const shown = this.models.get(name);
    if (!shown?.held) {
      return;
    }
    const { pivot } = shown.held;
    shown.holder.quaternion.setFromAxisAngle(UP, yaw);
    shown.holder.scale.setScalar(factor);
    const turned = pivot.clone().applyQuaternion(shown.holder.quaternion).multiplyScalar(factor);
    shown.holder.position.copy(pivot).add(by).sub(turned);
    this.viewport.invalidate();
  }

  /** Let go: the simulator says again where it is. */
  release(name: string): void {
    const shown = this.models.get(name);
    if (shown) {
      shown.held = undefined;
      shown.holder.position.set(0, 0, 0);
      shown.holder.quaternion.identity();
      shown.holder.scale.setScalar(1);
    }
  }

  draw(page: number): void {
    const shown = this.models.get(this.selected.value);
    this.frame.visible = shown !== undefined;
    if (shown) {
      this.frame.setFromObject(shown.holder);
    }
    this.viewport.lights.follow(this.viewport.view.focus);
    this.viewport.frame(page);
  }

  dispose(): void {
    for (const shown of this.models.values()) {
      this.drop(shown);
    }
    this.viewport.dispose();
  }

  private make(name: string, markers: Marker[], told: string): Shown {
    const shown: Shown = { name, holder: new Group(), links: new Map(), told };
    shown.holder.userData.model = name;
    for (const marker of markers) {
      if (isGround(marker)) {
        continue;
      }
      const link = marker.header.frame_id.split("::")[1] ?? "";
      const group = shown.links.get(link) ?? new Group();
      const object = markerObject(marker, {
        assets: this.context.assets,
        dark: true,
        changed: this.viewport.invalidate,
        complain: () => undefined, // a mesh that this page may not read: the rest is shown
      });
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
    this.viewport.invalidate();
  }

  /** Look at everything, once. */
  private look(): void {
    const all = new Box3();
    for (const { holder } of this.models.values()) {
      all.union(new Box3().setFromObject(holder));
    }
    if (!this.wasSeen && !all.isEmpty()) {
      this.wasSeen = true;
      const centre = all.getCenter(new Vector3());
      const distance = Math.max(3, 1.15 * all.getSize(new Vector3()).length());
      this.viewport.view.restore({ ...HOME, focus: [centre.x, centre.y, 0], distance });
    }
  }
}

const UP = new Vector3(0, 0, 1);

function isGround({ scale }: Marker): boolean {
  return scale.z < GROUND_THICKNESS_M && scale.x * scale.y > GROUND_M2;
}

function put(object: Object3D, { position, orientation }: Pose): void {
  object.position.set(position.x, position.y, position.z);
  object.quaternion.set(orientation.x, orientation.y, orientation.z, orientation.w);
}

/** A pose that is moved and turned about its own vertical. */
export function movedPose({ position, orientation }: Pose, by: Vector3, yaw: number): Pose {
  const { x, y, z, w } = new Quaternion()
    .setFromAxisAngle(UP, yaw)
    .multiply(new Quaternion(orientation.x, orientation.y, orientation.z, orientation.w));
  return {
    position: { x: position.x + by.x, y: position.y + by.y, z: position.z + by.z },
    orientation: { x, y, z, w },
  };
}
