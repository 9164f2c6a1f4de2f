// Service: calls services, as rqt's service caller does.
import { useSignal } from "@preact/signals";
import { toText } from "../ros/text";
import { Empty } from "../ui/empty";
import { Icon } from "../ui/icons";
import { DraftField, NameField, useDraft } from "./call/editor";
import { type BuiltInPanel, type PanelProps, withPreact } from "./panel";
import "../styles/call.css";

function ServicePanel({ studio: { session }, params, remember }: PanelProps) {
  const name = useSignal(typeof params.service === "string" ? params.service : "");
  const answer = useSignal("");
  const isWaiting = useSignal(false);
  const service = session.services.value.find((each) => each.name === name.value);
  const draft = useDraft(session, "service", name.value, service !== undefined);
  const call = async () => {
    const request = draft.read();
    if (request === undefined) {
      return;
    }
    [answer.value, isWaiting.value] = ["", true];
    try {
      answer.value = toText(await session.call(name.value, request));
    } catch (error) {
      draft.error.value = error instanceof Error ? error.message : String(error);
    }
    isWaiting.value = false;
  };
  return (
    <div class="column">
      <div class="bar">
        <NameField
          id="service-name"
          label="Service, such as /clear"
          value={name.value}
          names={session.services.value.map((each) => each.name)}
          onChange={(chosen) => {
            [name.value, answer.value] = [chosen, ""];
            remember({ service: chosen });
          }}
        />
        <button
          class="button primary"
          data-test="call"
          disabled={!service || isWaiting.value}
          onClick={() => void call()}
        >
          <Icon name="play" /> Call
        </button>
      </div>
      {service ? (
        <>
          <DraftField draft={draft} label="Request" />
          <pre class="answer mono scroll" data-test="answer">
            {isWaiting.value ? "…" : answer.value}
          </pre>
        </>
      ) : (
        <Empty icon="message" title={name.value ? "This service has no server" : "No service selected"}>
          {name.value ? "" : "Type a part of its name above."}
        </Empty>
      )}
      <footer class="bar faint">
        <span class="ellipsis">{service?.type ?? ""}</span>
        <span class="stretch" />
        <span class="error-text ellipsis" role="alert" title={draft.error.value}>
          {draft.error.value}
        </span>
      </footer>
    </div>
  );
}

export default {
  id: "service",
  title: "Service",
  icon: "arrow",
  mount: withPreact(ServicePanel),
} satisfies BuiltInPanel;
