// Publish Point, Measure and Focus: tools that need clicks only.
import { Mesh, MeshBasicMaterial, SphereGeometry, type Vector3 } from "three";
import { disposeTree } from "../displays/display";
import { toStamp } from "../ros/time";
import { Layer } from "../scene/layers";
import { setLinePoints, thickLine } from "../scene/shapes";
import type { Pointer, Tool, ToolContext, ToolType } from "./tool";

const COLOR = "#facc15";

/** A ball that follows the mouse over what can be hit. */
class Cursor {
  readonly mesh = new Mesh(
    new SphereGeometry(0.035, 20, 14),
    new MeshBasicMaterial({ color: COLOR, transparent: true, opacity: 0.9, depthTest: false }),
  );

  constructor(private readonly context: ToolContext) {
    this.mesh.renderOrder = Layer.TOOL;
    this.mesh.visible = false;
    context.overlay.add(this.mesh);
  }

  follow(point: Vector3 | undefined): void {
    this.mesh.visible = point !== undefined;
    if (point) {
      this.mesh.position.copy(point);
    }
    this.context.invalidate();
  }

  dispose(): void {
    disposeTree(this.mesh);
    this.mesh.removeFromParent();
    this.context.invalidate();
  }
}

class PublishPoint implements Tool {
  private readonly cursor: Cursor;

  constructor(private readonly context: ToolContext) {
    this.cursor = new Cursor(context);
  }

  moved(at: Pointer): void {
    const point = at.surface();
    this.cursor.follow(point);
    this.context.showMessage(point ? words(point) : PUBLISH_POINT.hint);
  }

  released(at: Pointer): void {
    const point = at.surface();
    if (point) {
      const { x, y, z } = point;
      this.context.publish("/clicked_point", "geometry_msgs/msg/PointStamped", {
        header: { stamp: toStamp(this.context.now()), frame_id: this.context.fixedFrame() },
        point: { x, y, z },
      });
      this.context.finish();
    }
  }

  dispose(): void {
    this.cursor.dispose();
  }
}

class Measure implements Tool {
  private readonly cursor: Cursor;
  private readonly line = thickLine(COLOR, 3);
  private start: Vector3 | undefined;
  private end: Vector3 | undefined;

  constructor(private readonly context: ToolContext) {
    this.cursor = new Cursor(context);
    this.line.material.depthTest = false;
    this.line.renderOrder = Layer.TOOL;
    this.line.visible = false;
    context.overlay.add(this.line);
  }

  moved(at: Pointer): void {
    const point = at.surface();
    this.cursor.follow(point);
    if (point && this.start && !this.end) {
      this.draw(this.start, point);
    }
  }

  released(at: Pointer): void {
    const point = at.surface()?.clone();
    if (!point) {
      return;
    }
    if (this.start && !this.end) {
      this.end = point;
      this.draw(this.start, point);
    } else {
      [this.start, this.end] = [point, undefined];
    }
  }

  dispose(): void {
    this.cursor.dispose();
    disposeTree(this.line);
    this.line.removeFromParent();
  }

  private draw(from: Vector3, to: Vector3): void {
    setLinePoints(this.line, [...from.toArray(), ...to.toArray()]);
    this.context.showMessage(`Length ${from.distanceTo(to).toFixed(3)} m`);
    this.context.invalidate();
  }
}

class Focus implements Tool {
  constructor(private readonly context: ToolContext) {}

  released(at: Pointer): void {
    const point = at.surface();
    if (point) {
      this.context.focusOn(point);
      this.context.finish();
    }
  }

  dispose(): void {
    this.context.invalidate();
  }
}

function words({ x, y, z }: Vector3): string {
  return `x ${x.toFixed(3)} m, y ${y.toFixed(3)} m, z ${z.toFixed(3)} m`;
}

export const PUBLISH_POINT: ToolType = {
  id: "point",
  title: "Publish Point",
  key: "u",
  icon: "point",
  hint: "Click a point to publish it on /clicked_point",
  create: (context) => new PublishPoint(context),
};

export const MEASURE: ToolType = {
  id: "measure",
  title: "Measure",
  key: "n",
  icon: "measure",
  hint: "Click two points to measure between them",
  create: (context) => new Measure(context),
};

export const FOCUS: ToolType = {
  id: "focus",
  title: "Focus Camera",
  key: "f",
  icon: "focus",
  hint: "Click the point around which the camera rotates",
  create: (context) => new Focus(context),
};
