import { expect, it } from "vitest";
import { beside, colladaImages } from "./assets";

it.each([
  ["package://robot/meshes/arm.dae", "arm.png", "package://robot/meshes/arm.png"],
  ["package://robot/meshes/arm.dae", "./skin/arm.png", "package://robot/meshes/skin/arm.png"],
  ["package://robot/meshes/arm.dae", "../textures/arm.png", "package://robot/textures/arm.png"],
  ["file:///opt/robot/arm.gltf", "arm.bin", "file:///opt/robot/arm.bin"],
  ["package://robot/arm.dae", "package://other/arm.png", "package://other/arm.png"],
])("finds beside %s the file %s", (uri, reference, expected) => {
  expect(beside(uri, reference)).toBe(expected);
});

it("reads the files of a COLLADA file's images, and not what its surfaces refer to", () => {
  const surface = "<newparam sid='s'><surface type='2D'><init_from>ID7</init_from></surface></newparam>";
  const image = "<library_images><image id='ID7'>\n<init_from> wood.png </init_from></image></library_images>";
  const newer = "<image id='a'><init_from><ref>stone.png</ref></init_from></image>";
  expect(colladaImages(surface + image + newer)).toEqual(["wood.png", "stone.png"]);
});
