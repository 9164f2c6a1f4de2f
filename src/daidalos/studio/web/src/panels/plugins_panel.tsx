// Plugins: what rqt offers, in the groups of its menu; each opens as a panel.
import type { Studio } from "../app/studio";
import { Icon, iconNamed } from "../ui/icons";
import { PANELS } from "./registry";
import { type BuiltInPanel, type PanelProps, withPreact } from "./panel";
import "../styles/plugins.css";

type Plugins = readonly (readonly [panel: string, title: string])[];

/** The groups of rqt's menu, with the panels by the names of its plugins. */
const GROUPS: readonly (readonly [group: string, plugins: Plugins])[] = [
  ["Configuration", [["parameters", "Dynamic Reconfigure"]]],
  ["Introspection", [["graph", "Node Graph"]]],
  ["Logging", [["log", "Console"]]],
  ["Robot Tools", [["joints", "Joint Sliders"]]],
  ["Services", [["service", "Service Caller"]]],
  [
    "Topics",
    [
      ["topics", "Topic Monitor"],
      ["message", "Message"],
      ["publish", "Message Publisher"],
    ],
  ],
  [
    "Visualization",
    [
      ["plot", "Plot"],
      ["image", "Image View"],
      ["scene", "RViz"],
      ["simulation", "Gazebo"],
      ["turtlesim", "Turtlesim"],
    ],
  ],
];

function PluginsPanel({ studio }: PanelProps) {
  const known = new Set(GROUPS.flatMap(([, plugins]) => plugins.map(([panel]) => panel)));
  const own = PANELS.list
    .filter(({ id }) => !known.has(id) && !HIDDEN.includes(id))
    .map(({ id, title }) => [id, title] as const);
  const groups = own.length ? [...GROUPS, ["Others", own] as const] : GROUPS;
  return (
    <div class="scroll plugins">
      {groups.map(([group, plugins]) => (
        <section key={group}>
          <h2>{group}</h2>
          {plugins.map(([panel, title]) => (
            <Plugin key={panel} studio={studio} panel={panel} title={title} />
          ))}
        </section>
      ))}
    </div>
  );
}

/** Panels that make sense only beside others. */
const HIDDEN = ["plugins", "displays", "entities", "camera"];

function Plugin({ studio, panel, title }: { studio: Studio; panel: string; title: string }) {
  return (
    <button class="plugin" data-plugin={panel} onClick={() => studio.openPanel(panel)}>
      <Icon name={iconNamed(PANELS.find(panel)?.icon, "panel")} />
      {title}
    </button>
  );
}

export default {
  id: "plugins",
  title: "Plugins",
  icon: "panel",
  mount: withPreact(PluginsPanel),
} satisfies BuiltInPanel;
