// Controllers: those of a controller manager and its hardware, loaded, started and stopped as in rqt's controller manager.
import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import type { Session } from "../contract";
import type {
  CleanupController,
  ConfigureController,
  ControllerState,
  HardwareComponentState,
  ListControllers,
  ListHardwareComponents,
  SetHardwareComponentState,
  SwitchController,
  UnloadController,
} from "../generated/controller_manager_msgs";
import { Choice } from "../ui/editors";
import { Empty } from "../ui/empty";
import { type BuiltInPanel, type PanelProps, withPreact } from "./panel";
import "../styles/controllers.css";

const SERVICE = "/list_controllers";
const TYPE = "controller_manager_msgs/srv/ListControllers";
const PERIOD_MS = 1000;
const STRICT = 2;
/** What can be done in each state of a controller, and of hardware. */
const STEPS: Record<string, readonly Step[]> = {
  unconfigured: ["configure", "unload"],
  inactive: ["activate", "cleanup", "unload"],
  active: ["deactivate"],
};
const HARDWARE_STEPS: Record<string, readonly string[]> = {
  unconfigured: ["inactive"],
  inactive: ["active", "unconfigured"],
  active: ["inactive"],
};

type Step = "configure" | "activate" | "deactivate" | "cleanup" | "unload";

function ControllersPanel({ studio: { session }, visible, params, remember }: PanelProps) {
  const managers = session.services.value
    .filter(({ name, type }) => type === TYPE && name.endsWith(SERVICE))
    .map(({ name }) => name.slice(0, -SERVICE.length));
  const chosen = useSignal(typeof params.manager === "string" ? params.manager : "");
  const manager = managers.includes(chosen.value) ? chosen.value : (managers[0] ?? "");
  return (
    <div class="column">
      <div class="bar">
        <Choice
          label="Controller manager"
          value={manager}
          options={managers.map((name) => [name, name])}
          onChange={(name) => {
            chosen.value = name;
            remember({ manager: name });
          }}
        />
      </div>
      {manager ? (
        <Manager key={manager} session={session} manager={manager} isVisible={visible.value} />
      ) : (
        <Empty icon="sliders" title="No controller manager">
          It appears as soon as one is running.
        </Empty>
      )}
    </div>
  );
}

function Manager({ session, manager, isVisible }: { session: Session; manager: string; isVisible: boolean }) {
  const controllers = useSignal<readonly ControllerState[]>([]);
  const hardware = useSignal<readonly HardwareComponentState[]>([]);
  const error = useSignal("");
  const attempt = async (work: () => Promise<unknown>) => {
    try {
      await work();
      error.value = "";
    } catch (problem) {
      error.value = problem instanceof Error ? problem.message : String(problem);
    }
  };
  const read = async () => {
    const [listed, components] = await Promise.all([
      session.call<ListControllers>(`${manager}${SERVICE}`, {}),
      session.call<ListHardwareComponents>(`${manager}/list_hardware_components`, {}),
    ]);
    [controllers.value, hardware.value] = [listed.controller, components.component];
  };
  useEffect(() => {
    if (!isVisible) {
      return undefined;
    }
    void attempt(read);
    const timer = setInterval(() => void attempt(read), PERIOD_MS);
    return () => clearInterval(timer);
  }, [isVisible]);
  const act = (work: () => Promise<string>) => {
    void attempt(async () => {
      const problem = await work();
      await read();
      if (problem) {
        throw new Error(problem);
      }
    });
  };
  return (
    <>
      <div class="scroll controllers">
        <h3 class="faint">Controllers</h3>
        {controllers.value.map(({ name, type, state }) => (
          <Row key={name} name={name} detail={type} state={state}>
            {(STEPS[state] ?? []).map((step) => (
              <button class="button" data-step={step} onClick={() => act(() => take(session, manager, name, step))}>
                {step}
              </button>
            ))}
          </Row>
        ))}
        <h3 class="faint">Hardware</h3>
        {hardware.value.map(({ name, plugin_name, state }) => (
          <Row key={name} name={name} detail={plugin_name} state={state.label}>
            {(HARDWARE_STEPS[state.label] ?? []).map((target) => (
              <button class="button" onClick={() => act(() => setHardware(session, manager, name, target))}>
                {target}
              </button>
            ))}
          </Row>
        ))}
      </div>
      <footer class="bar">
        <span class="error-text ellipsis" role="alert" title={error.value}>
          {error.value}
        </span>
      </footer>
    </>
  );
}

function Row(props: { name: string; detail: string; state: string; children: preact.ComponentChildren }) {
  return (
    <div class="controller-row" data-name={props.name} data-state={props.state}>
      <span class="controller-name">
        <span class="ellipsis">{props.name}</span>
        <span class="faint ellipsis">{props.detail}</span>
      </span>
      <span class={`controller-state ${props.state}`}>{props.state}</span>
      {props.children}
    </div>
  );
}

/** Take a controller one step on; return why that failed, nothing where it did not. */
async function take(session: Session, manager: string, name: string, step: Step): Promise<string> {
  const failed = `${name}: ${step} failed; see the controller manager's log`;
  switch (step) {
    case "configure":
      return (await session.call<ConfigureController>(`${manager}/configure_controller`, { name })).ok ? "" : failed;
    case "cleanup":
      return (await session.call<CleanupController>(`${manager}/cleanup_controller`, { name })).ok ? "" : failed;
    case "unload":
      return (await session.call<UnloadController>(`${manager}/unload_controller`, { name })).ok ? "" : failed;
    default: {
      const { ok, message } = await session.call<SwitchController>(`${manager}/switch_controller`, {
        activate_controllers: step === "activate" ? [name] : [],
        deactivate_controllers: step === "deactivate" ? [name] : [],
        strictness: STRICT,
        activate_asap: true,
        timeout: { sec: 5, nanosec: 0 },
      });
      return ok ? "" : message || failed;
    }
  }
}

async function setHardware(session: Session, manager: string, name: string, label: string): Promise<string> {
  const { ok } = await session.call<SetHardwareComponentState>(`${manager}/set_hardware_component_state`, {
    name,
    target_state: { id: 0, label },
  });
  return ok ? "" : `${name} does not become ${label}; see the controller manager's log`;
}

export default {
  id: "controllers",
  title: "Controllers",
  icon: "sliders",
  mount: withPreact(ControllersPanel),
} satisfies BuiltInPanel;
