// TF: where the frames are, and which hangs on which.
import {
  BufferGeometry,
  DynamicDrawUsage,
  Float32BufferAttribute,
  InstancedMesh,
  LineBasicMaterial,
  LineSegments,
  Matrix4,
  MeshBasicMaterial,
  Vector3,
} from "three";
import { Layer } from "../../scene/layers";
import { placeLabels } from "../../scene/label_layout";
import { axesGeometry, Label } from "../../scene/shapes";
import { Transform } from "../../tf/buffer";
import type { Settings } from "../../contract";
import { Display, type DisplayContext, type FrameInfo, type BuiltInDisplay } from "../display";
import { flag, number } from "../settings";

const LABEL_PIXELS = 19;
const THICKNESS = 0.026;

class TfDisplay extends Display {
  private axes: InstancedMesh | undefined;
  private readonly links = new LineSegments(
    new BufferGeometry(),
    new LineBasicMaterial({ color: 0xd8b86a, transparent: true, opacity: 0.5, depthTest: false }),
  );
  private readonly labels = new Map<string, Label>();
  private before = "";

  constructor(context: DisplayContext, settings: Settings) {
    super(context, settings);
    this.links.frustumCulled = false;
    this.links.renderOrder = Layer.LINK;
    this.object.add(this.links);
  }

  override update(frame: FrameInfo): void {
    const { tf } = this.context;
    const poses = new Map<string, Transform>();
    for (const name of tf.frames()) {
      const pose = new Transform();
      if (tf.lookup(frame.fixed, name, frame.time, pose, { clamp: true })) {
        poses.set(name, pose);
      }
    }
    const total = tf.frames().length;
    const lost = total - poses.size;
    if (total === 0) {
      this.report("idle", "no transforms yet");
    } else if (lost) {
      this.report("warning", `${lost} of ${total} frames are not connected to ${frame.fixed}`);
    } else {
      this.report("ok", `${total} frames`);
    }
    this.drawAxes([...poses.values()]);
    this.drawLinks(poses);
    this.drawLabels(poses, frame);
    const state = [...poses.values()]
      .map(({ position: p, rotation: r }) => [...p.toArray(), ...r.toArray()].map((each) => each.toFixed(4)).join())
      .join();
    if (state !== this.before) {
      this.before = state;
      this.context.invalidate();
    }
  }

  override restyle(settings: Settings): void {
    super.restyle(settings);
    this.before = "";
  }

  private drawAxes(poses: Transform[]): void {
    const axes = this.roomForAxes(poses.length);
    const scale = new Vector3().setScalar(number(this.settings, "scale"));
    const matrix = new Matrix4();
    axes.count = flag(this.settings, "axes") ? poses.length : 0;
    poses.forEach((pose, i) => axes.setMatrixAt(i, matrix.compose(pose.position, pose.rotation, scale)));
    axes.instanceMatrix.needsUpdate = true;
  }

  private roomForAxes(count: number): InstancedMesh {
    if (!this.axes || this.axes.instanceMatrix.count < count) {
      this.axes?.geometry.dispose();
      this.axes?.removeFromParent();
      const material = new MeshBasicMaterial({ vertexColors: true });
      this.axes = new InstancedMesh(axesGeometry(THICKNESS), material, count + 16);
      this.axes.instanceMatrix.setUsage(DynamicDrawUsage);
      this.axes.frustumCulled = false;
      this.object.add(this.axes);
    }
    return this.axes;
  }

  private drawLinks(poses: Map<string, Transform>): void {
    const ends: number[] = [];
    if (flag(this.settings, "links")) {
      for (const [name, pose] of poses) {
        const parent = poses.get(this.context.tf.parentOf(name) ?? "");
        if (parent) {
          ends.push(...pose.position.toArray(), ...parent.position.toArray());
        }
      }
    }
    this.links.geometry.setAttribute("position", new Float32BufferAttribute(ends, 3));
    this.links.visible = ends.length > 0;
  }

  private drawLabels(poses: Map<string, Transform>, frame: FrameInfo): void {
    const wanted = flag(this.settings, "names") ? poses : new Map<string, Transform>();
    for (const [name, label] of this.labels) {
      if (!wanted.has(name)) {
        label.material.map?.dispose();
        label.material.dispose();
        label.removeFromParent();
        this.labels.delete(name);
      }
    }
    const dark = this.context.theme() === "dark";
    for (const [name, pose] of wanted) {
      let label = this.labels.get(name);
      if (!label) {
        label = new Label(name, "#fff", "#000");
        this.labels.set(name, label);
        this.object.add(label);
      }
      label.write(name, dark ? "#dfe5ec" : "#27303b", dark ? "#0d1117" : "#f4f6f9");
      label.position.copy(pose.position);
      label.setHeight(LABEL_PIXELS * frame.view.metresPerPixel(pose.position, frame.height));
    }
    this.spread(frame);
  }

  /** Move the labels apart, as they are seen. */
  private spread({ view, width, height }: FrameInfo): void {
    const seen = [...this.labels.values()].flatMap((label) => {
      const at = label.position.clone().project(view.camera);
      const [x, y] = [((at.x + 1) / 2) * width, ((1 - at.y) / 2) * height];
      return Math.abs(at.z) <= 1 ? [{ label, x, y, width: LABEL_PIXELS * label.ratio }] : [];
    });
    placeLabels(seen, LABEL_PIXELS).forEach(({ left, top }, i) => {
      const { label, width: wide } = seen[i] as (typeof seen)[number];
      label.center.set(-left / wide, 1 + top / LABEL_PIXELS);
    });
  }
}

export default {
  id: "TF",
  icon: "axes",
  messages: [],
  properties: [
    { key: "axes", label: "Axes", kind: "toggle" },
    { key: "names", label: "Names", kind: "toggle" },
    { key: "links", label: "Links", kind: "toggle" },
    { key: "scale", label: "Axis length", kind: "number", min: 0.01, max: 10, step: 0.05, unit: "m" },
  ],
  defaults: { axes: true, names: false, links: false, scale: 0.09 },
  create: (context, settings) => new TfDisplay(context, settings),
} satisfies BuiltInDisplay;
