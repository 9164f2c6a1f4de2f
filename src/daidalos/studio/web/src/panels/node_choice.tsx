// Choice of the node that a panel shows; the panel remembers it.
import { type Signal, useSignal } from "@preact/signals";
import { Choice } from "../ui/editors";
import type { PanelProps } from "./panel";

/** The node that is chosen, an empty string where none was. */
export function useChosenNode({ params }: PanelProps): Signal<string> {
  return useSignal(typeof params.node === "string" ? params.node : "");
}

interface NodeChoiceProps {
  readonly nodes: readonly string[];
  readonly node: string;
  readonly chosen: Signal<string>;
  readonly remember: PanelProps["remember"];
}

/** A bar with the names of nodes. */
export function NodeChoice({ nodes, node, chosen, remember }: NodeChoiceProps) {
  return (
    <div class="bar">
      <Choice
        label="Node"
        value={node}
        options={nodes.map((name) => [name, name])}
        onChange={(name) => {
          chosen.value = name;
          remember({ node: name });
        }}
      />
    </div>
  );
}
