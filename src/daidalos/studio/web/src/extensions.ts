// The panels and displays that installed packages bring: listed by the server, loaded as ES modules.
import type { DisplayModule, DisplayType, Panel, PanelContext } from "./contract";
import { DISPLAYS } from "./displays/registry";
import { FailedDisplay } from "./displays/failed_display";
import { KIT } from "./displays/kit";
import type { PageModule, PageModules } from "./generated/extensions";
import { PANELS, type RegisteredPanel } from "./panels/registry";
import type { Registered } from "./registry";
import { showErrorLine } from "./ui/error_line";

const ADDRESS = "extensions.json";

/** Register what the packages bring; resolved when all of it can be used, or has failed. */
export async function loadExtensions(): Promise<void> {
  const modules = await fetchModules();
  for (const module of modules.panels) {
    PANELS.add(panelOf(module));
  }
  PANELS.isComplete.value = true;
  const displays = await Promise.all(modules.displays.map(displayOf));
  displays.forEach((display) => DISPLAYS.add(display));
  DISPLAYS.isComplete.value = true;
}

async function fetchModules(): Promise<PageModules> {
  const answer = await fetch(ADDRESS).catch(() => undefined);
  return answer?.ok ? ((await answer.json()) as PageModules) : { panels: [], displays: [] };
}

/** A panel whose module is loaded when it is opened; what goes wrong is one line in the panel. */
function panelOf(module: PageModule): RegisteredPanel {
  const registered: RegisteredPanel = {
    id: module.name,
    title: module.name.charAt(0).toUpperCase() + module.name.slice(1).replaceAll("_", " "),
    mount(element, context) {
      let unmount: (() => void) | void;
      let isOpen = true;
      const fail = (error: unknown) => showErrorLine(element, describe(module, error));
      load<Panel>(module)
        .then((panel) => {
          const { title, icon = "panel", many = false } = panel;
          PANELS.add({ ...registered, title, icon, many });
          if (isOpen) {
            unmount = panel.mount(element, guarded(context, fail));
          }
        })
        .catch(fail);
      return () => {
        isOpen = false;
        unmount?.();
      };
    },
  };
  return registered;
}

/** A kind of display; where its module fails, its displays report the error. */
async function displayOf(module: PageModule): Promise<Registered<DisplayType>> {
  const failed = (error: unknown) => ({
    create: () => new FailedDisplay(describe(module, error)),
  });
  try {
    const type = (await load<DisplayModule>(module))(KIT);
    return {
      ...type,
      id: module.name,
      create(context, settings) {
        try {
          return type.create(context, settings);
        } catch (error) {
          return failed(error).create();
        }
      },
    };
  } catch (error) {
    return { id: module.name, messages: [], properties: [], defaults: {}, ...failed(error) };
  }
}

async function load<T>({ url, error }: PageModule): Promise<T> {
  if (url === undefined) {
    throw new Error(error);
  }
  const loaded = (await import(/* @vite-ignore */ new URL(url, location.href).href)) as { default?: T };
  if (loaded.default === undefined) {
    throw new Error("the module has no default export");
  }
  return loaded.default;
}

/** The context for a module of another package: an error in one of its callbacks is passed to `fail`. */
function guarded(context: PanelContext, fail: (error: unknown) => void): PanelContext {
  const guard =
    <A extends unknown[]>(call: (...values: A) => void) =>
    (...values: A) => {
      try {
        call(...values);
      } catch (error) {
        fail(error);
      }
    };
  const { studio } = context;
  const { session } = studio;
  return {
    visible: {
      get value() {
        return context.visible.value;
      },
      subscribe: (call) => context.visible.subscribe(guard(call)),
    },
    params: context.params,
    remember: (params) => context.remember(params),
    studio: {
      session: {
        topics: session.topics,
        services: session.services,
        subscribe: (topic, keep, received) => session.subscribe(topic, keep, guard(received)),
        publish: (topic, type, message) => session.publish(topic, type, message),
        call: (service, request) => session.call(service, request),
        fetchAsset: (uri) => session.fetchAsset(uri),
      },
      now: () => studio.now(),
      onFrame: (call) => studio.onFrame(guard(call)),
      openPanel: (id, params) => studio.openPanel(id, params),
    },
  };
}

function describe({ name, origin }: PageModule, error: unknown): string {
  const reason = error instanceof Error ? error.message : String(error);
  return `${name} (${origin}): ${reason}`;
}
