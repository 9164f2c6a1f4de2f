// What is in a simulated world, as a tree: models with their links, joints, sensors and plugins.
import type { ModelParts } from "../../generated/daidalos_msgs";

export type EntityKind = "model" | "static" | "link" | "joint" | "sensor" | "plugin";

export interface Entity {
  /** With the names of what it belongs to: model::link::sensor. */
  id: string;
  name: string;
  kind: EntityKind;
  /** What kind of joint or sensor it is. */
  type: string;
  parts: readonly Entity[];
}

/** The model of an entity called model::link, and its link, which in a nested model is called nested::link. */
export function splitEntity(name: string): { model: string; link: string | undefined } {
  const end = name.indexOf("::");
  return end < 0 ? { model: name, link: undefined } : { model: name.slice(0, end), link: name.slice(end + 2) };
}

/** Build the tree; `entities` are models by their names and links as model::link. */
export function entityTree(entities: readonly string[], models: readonly ModelParts[]): Entity[] {
  return entities
    .filter((name) => !name.includes("::"))
    .map((name) => {
      const parts = models.find((each) => each.name === name);
      const links = entities.filter((each) => each.startsWith(`${name}::`)).map((each) => each.slice(name.length + 2));
      const kind = parts?.is_static ? "static" : "model";
      return { id: name, name, kind, type: "", parts: parts ? partsOf(name, links, parts) : [] };
    });
}

function partsOf(model: string, links: readonly string[], parts: ModelParts): Entity[] {
  const entity = (name: string, kind: EntityKind, type = "", own: Entity[] = []): Entity => ({
    id: `${model}::${name}`,
    name,
    kind,
    type,
    parts: own,
  });
  const sensorsOf = (carrier: string) =>
    parts.sensors.flatMap((sensor, i) =>
      sensor.slice(0, sensor.lastIndexOf("::")) === carrier
        ? [{ ...entity(sensor, "sensor", parts.sensor_types[i]), name: sensor.slice(carrier.length + 2) }]
        : [],
    );
  return [
    ...links.map((link) => entity(link, "link", "", sensorsOf(link))),
    ...parts.joints.map((joint, i) => entity(joint, "joint", parts.joint_types[i], sensorsOf(joint))),
    ...parts.plugins.map((plugin) => entity(plugin, "plugin")),
  ];
}

/** What a filter leaves of a tree: entities whose names or types contain the text, with those they belong to. */
export function filterTree(entities: readonly Entity[], text: string): readonly Entity[] {
  const wanted = text.toLowerCase();
  return wanted === ""
    ? entities
    : entities.flatMap((each) => {
        const parts = filterTree(each.parts, text);
        const matches = each.name.toLowerCase().includes(wanted) || each.type.toLowerCase().includes(wanted);
        return matches ? [each] : parts.length ? [{ ...each, parts }] : [];
      });
}
