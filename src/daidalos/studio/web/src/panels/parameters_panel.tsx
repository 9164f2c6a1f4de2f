// Parameters: those of a node with an editor each, as rqt's dynamic reconfigure has them.
import { useSignal } from "@preact/signals";
import { useEffect, useMemo } from "preact/hooks";
import type { Session } from "../contract";
import { ParameterType } from "../generated/rcl_interfaces";
import { NodeParameters } from "../parameters/node_parameters";
import { isArray, isInteger, type Parameter, type Value } from "../parameters/values";
import { Choice, RangeField, TextField, Toggle } from "../ui/editors";
import { Empty } from "../ui/empty";
import { SearchField } from "../ui/search";
import { NodeChoice, useChosenNode } from "./node_choice";
import { type BuiltInPanel, type PanelProps, withPreact } from "./panel";
import "../styles/parameters.css";

const SERVICE = "/describe_parameters";
const TYPE = "rcl_interfaces/srv/DescribeParameters";

function ParametersPanel(props: PanelProps) {
  const { session } = props.studio;
  const nodes = session.services.value
    .filter(({ name, type }) => type === TYPE && name.endsWith(SERVICE) && !/(^|\/)_/.test(name))
    .map(({ name }) => name.slice(0, -SERVICE.length));
  const node = useChosenNode(props);
  return (
    <div class="column">
      <NodeChoice nodes={nodes} node={node.value} chosen={node} remember={props.remember} />
      {nodes.includes(node.value) ? (
        <Editors key={node.value} session={session} node={node.value} isVisible={props.visible.value} />
      ) : (
        <Empty icon="sliders" title={node.value ? `${node.value} is not running` : "No node selected"}>
          {nodes.length ? "Select one above." : "No node has parameter services."}
        </Empty>
      )}
    </div>
  );
}

function Editors({ session, node, isVisible }: { session: Session; node: string; isVisible: boolean }) {
  const parameters = useMemo(() => new NodeParameters(session, node), []);
  const filter = useSignal("");
  useEffect(() => (isVisible ? parameters.follow() : undefined), [isVisible]);
  const wanted = filter.value.toLowerCase();
  const shown = parameters.all.value.filter(({ name }) => name.toLowerCase().includes(wanted));
  const error = parameters.error.value;
  return (
    <>
      <div class="bar">
        <SearchField value={filter.value} placeholder="Filter by name" onChange={(text) => (filter.value = text)} />
        <span class="faint figures">{shown.length}</span>
      </div>
      <div class="scroll parameters">
        {shown.map((parameter) => (
          <Row
            key={parameter.name}
            parameter={parameter}
            onChange={(value) => parameters.set(parameter.name, value)}
            onError={(text) => (parameters.error.value = text)}
          />
        ))}
      </div>
      {error && (
        <footer class="bar">
          <span class="error-text ellipsis" role="alert" title={error}>
            {error}
          </span>
        </footer>
      )}
    </>
  );
}

interface EditorProps {
  parameter: Parameter;
  onChange(value: Value): void;
  onError(text: string): void;
}

function Row(props: EditorProps) {
  const { name, description, constraints, isReadOnly } = props.parameter;
  const notes = [description, constraints, isReadOnly ? "read-only" : ""].filter(Boolean);
  return (
    <label class="parameter" data-parameter={name} title={[name, ...notes].join("\n")}>
      <span class="parameter-name ellipsis">{name}</span>
      <Editor {...props} />
    </label>
  );
}

function Editor({ parameter, onChange, onError }: EditorProps) {
  const { name, type, value, unit, choices, lower, upper, step, isReadOnly } = parameter;
  const common = { label: name, disabled: isReadOnly };
  if (value === undefined) {
    return <span class="faint">not set</span>;
  }
  if (typeof value === "boolean") {
    return <Toggle {...common} on={value} onChange={onChange} />;
  }
  if (choices.length && !isArray(type)) {
    const chosen = (text: string) => onChange(type === ParameterType.PARAMETER_STRING ? text : Number(text));
    const options = choices.map((text) => [text, text] as const);
    return <Choice {...common} value={String(value)} options={options} onChange={chosen} />;
  }
  if (typeof value === "number") {
    const smallest = isInteger(type) ? Math.max(1, step) : step;
    return <RangeField {...common} {...{ value, unit, onChange }} min={lower} max={upper} step={smallest} />;
  }
  if (typeof value === "string") {
    return <TextField {...common} value={value} onChange={onChange} />;
  }
  const enter = (text: string) => {
    try {
      onChange(arrayOf(text));
    } catch (error) {
      onError(`${name}: ${(error as Error).message}`);
    }
  };
  return <TextField {...common} value={JSON.stringify(value)} onChange={enter} />;
}

function arrayOf(text: string): Value {
  const value: unknown = JSON.parse(text);
  if (!Array.isArray(value)) {
    throw new Error("expected a list such as [1, 2]");
  }
  return value as Value;
}

export default {
  id: "parameters",
  title: "Parameters",
  icon: "sliders",
  many: true,
  mount: withPreact(ParametersPanel),
} satisfies BuiltInPanel;
