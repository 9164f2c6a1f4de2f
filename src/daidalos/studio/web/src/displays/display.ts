// The base of the page's own displays; see contract.ts.
import { signal } from "@preact/signals";
import { Box3, Group, type Material, type Mesh, type Object3D, type Texture } from "three";
import type { Session } from "../connection/session";
import type * as contract from "../contract";
import type { Settings, Status } from "../contract";
import type { Registered } from "../registry";
import type { Assets } from "../scene/assets";
import type { View } from "../scene/view";
import { Transform, type TransformBuffer, type When } from "../tf/buffer";
import type { IconName } from "../ui/icons";

export interface DisplayContext extends contract.DisplayContext {
  readonly session: Session;
  readonly tf: TransformBuffer;
  readonly assets: Assets;
}

export interface FrameInfo extends contract.FrameInfo {
  readonly view: View;
  /** Of the view, in pixels. */
  readonly width: number;
  readonly height: number;
}

export interface BuiltInDisplay extends Registered<contract.DisplayType> {
  readonly icon: IconName;
  create(context: DisplayContext, settings: Settings): Display;
}

export abstract class Display implements contract.Display {
  readonly object = new Group();
  readonly status = signal<Status>({ level: "idle", text: "" });

  constructor(
    protected readonly context: DisplayContext,
    protected settings: Settings,
  ) {}

  /** Take over changed settings (never another topic: that makes another display). */
  restyle(settings: Settings): void {
    this.settings = settings;
    this.context.invalidate();
  }

  /** Bring the scene up to date; once per drawn frame. */
  update(_frame: FrameInfo): void {}

  /** Where it draws what the first view is to show, in the fixed frame; empty where it has no extent of its own. */
  bounds(): Box3 {
    return new Box3();
  }

  dispose(): void {
    disposeTree(this.object);
    this.object.removeFromParent();
    this.context.invalidate();
  }

  protected report(level: Status["level"], text: string): void {
    const before = this.status.peek();
    if (before.level !== level || before.text !== text) {
      this.status.value = { level, text };
    }
  }
}

const POSE = new Transform();
/** Motion below this since the last frame, in metres or as a quaternion, is not drawn: wheels at rest jitter. */
const MIN_MOTION = 2e-5;

/** Put an object where a frame is; false where that is not known. */
export function place(
  context: DisplayContext,
  object: Object3D,
  fixed: string,
  frame: string,
  when: When,
  clamp: boolean,
): boolean {
  if (frame === fixed) {
    POSE.identity();
  } else if (!context.tf.lookup(fixed, frame, when, POSE, { clamp })) {
    return false;
  }
  // A scene in which nothing moves is not drawn again.
  if (isElsewhere(object, POSE)) {
    object.position.copy(POSE.position);
    object.quaternion.copy(POSE.rotation);
    context.invalidate();
  }
  return true;
}

/** Whether an object is drawn elsewhere than at a pose, by more than the trembling of what stands still. */
export function isElsewhere({ position: p, quaternion: q }: Object3D, { position, rotation: r }: Transform): boolean {
  const turned = Math.max(Math.abs(q.x - r.x), Math.abs(q.y - r.y), Math.abs(q.z - r.z), Math.abs(q.w - r.w));
  return (
    Math.max(Math.abs(p.x - position.x), Math.abs(p.y - position.y), Math.abs(p.z - position.z), turned) > MIN_MOTION
  );
}

/** Free the graphics memory of an object and all below it. */
export function disposeTree(root: Object3D): void {
  root.traverse((object) => {
    const mesh = object as Partial<Mesh>;
    if (!object.userData.sharesGeometry) {
      mesh.geometry?.dispose();
    }
    const materials = mesh.material ? [mesh.material].flat() : [];
    for (const material of materials) {
      disposeMaterial(material);
    }
  });
}

function disposeMaterial(material: Material): void {
  for (const value of Object.values(material)) {
    if ((value as Texture | null)?.isTexture) {
      (value as Texture).dispose();
    }
  }
  material.dispose();
}
