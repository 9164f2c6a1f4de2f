import { expect, it } from "vitest";
import { beside } from "./assets";

it.each([
  ["package://robot/meshes/arm.dae", "arm.png", "package://robot/meshes/arm.png"],
  ["package://robot/meshes/arm.dae", "./skin/arm.png", "package://robot/meshes/skin/arm.png"],
  ["package://robot/meshes/arm.dae", "../textures/arm.png", "package://robot/textures/arm.png"],
  ["file:///opt/robot/arm.gltf", "arm.bin", "file:///opt/robot/arm.bin"],
  ["package://robot/arm.dae", "package://other/arm.png", "package://other/arm.png"],
])("finds beside %s the file %s", (uri, reference, expected) => {
  expect(beside(uri, reference)).toBe(expected);
});
