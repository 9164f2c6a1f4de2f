import { expect, it } from "vitest";
import { entityTree, filterTree, splitEntity, type Entity } from "./entity_tree";

const PARTS = {
  name: "bot",
  is_static: false,
  joints: ["wheel_joint", "wrist"],
  joint_types: ["continuous", "fixed"],
  sensors: ["arm::hand::camera", "base::lidar", "wrist::force"],
  sensor_types: ["camera", "gpu_lidar", "force_torque"],
  plugins: ["drive"],
};
const ROOM = { ...PARTS, name: "room", is_static: true, joints: [], sensors: [], plugins: [] };
const NAMES = ["room", "room::wall", "bot", "bot::base", "bot::arm::hand"];

/** A tree in a line. */
const written = (entities: readonly Entity[]): string =>
  entities.map(({ name, kind, parts }) => `${kind} ${name}${parts.length ? `(${written(parts)})` : ""}`).join(", ");

it("has each part where it belongs, also in nested models", () => {
  const [room, bot] = entityTree(NAMES, [ROOM, PARTS]) as [Entity, Entity];
  expect(written([room])).toBe("static room(link wall)");
  expect(written([bot])).toBe(
    "model bot(link base(sensor lidar), link arm::hand(sensor camera), joint wheel_joint, " +
      "joint wrist(sensor force), plugin drive)",
  );
  expect(bot.parts[1]?.parts[0]).toMatchObject({ id: "bot::arm::hand::camera", type: "camera" });
});

it("shows models of a simulator that does not tell their parts", () => {
  expect(written(entityTree(NAMES, []))).toBe("model room, model bot");
});

it("keeps with what is found where that is", () => {
  const tree = entityTree(NAMES, [ROOM, PARTS]);
  expect(written(filterTree(tree, "LIDAR"))).toBe("model bot(link base(sensor lidar))");
  expect(written(filterTree(tree, "wall"))).toBe("static room(link wall)");
  expect(filterTree(tree, "")).toBe(tree);
  expect(filterTree(tree, "nothing")).toEqual([]);
});

it("tells links of nested models from their models", () => {
  expect(splitEntity("bot")).toEqual({ model: "bot", link: undefined });
  expect(splitEntity("bot::base")).toEqual({ model: "bot", link: "base" });
  expect(splitEntity("house::room::wall")).toEqual({ model: "house", link: "room::wall" });
});
