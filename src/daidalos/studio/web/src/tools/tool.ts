// The contract of a tool: what the left mouse button does in the 3-D view.
import type { Object3D, Vector3 } from "three";
import type { IconName } from "../ui/icons";

export interface Pointer {
  /** Pixels from the canvas' upper left corner. */
  x: number;
  y: number;
  /** Where the ray meets the ground; undefined above the horizon. */
  ground: Vector3 | undefined;
  /** The nearest surface, else the ground. */
  surface(): Vector3 | undefined;
}

export interface ToolContext {
  /** Where tools draw. */
  readonly overlay: Object3D;
  fixedFrame(): string;
  /** Robot time, in seconds. */
  now(): number;
  publish(topic: string, type: string, message: unknown): void;
  focusOn(point: Vector3): void;
  /** Show a line for the user under the view. */
  showMessage(text: string): void;
  /** Deselect the tool: the mouse moves the camera again. */
  finish(): void;
  invalidate(): void;
}

export interface Tool {
  pressed?(at: Pointer): void;
  moved?(at: Pointer, isPressed: boolean): void;
  released?(at: Pointer): void;
  /** Called when another tool is selected, or Escape is pressed. */
  dispose(): void;
}

export interface ToolType {
  readonly id: string;
  readonly title: string;
  /** RViz's key. */
  readonly key: string;
  readonly icon: IconName;
  readonly hint: string;
  /** Absent for the tool that leaves the mouse to the camera. */
  readonly create?: (context: ToolContext) => Tool;
}
