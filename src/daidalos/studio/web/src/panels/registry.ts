// The panels, in the order of the menu: adding one means a file beside this one and a line below.
import { DISPLAYS_PANEL } from "./displays_panel";
import { GRAPH_PANEL } from "./graph_panel";
import { IMAGE_PANEL } from "./image_panel";
import { JOINTS_PANEL } from "./joints_panel";
import { LOG_PANEL } from "./log_panel";
import { MESSAGE_PANEL } from "./message_panel";
import type { PanelType } from "./panel";
import { PLOT_PANEL } from "./plot_panel";
import { PUBLISH_PANEL } from "./publish_panel";
import { SCENE_PANEL } from "./scene_panel";
import { SERVICE_PANEL } from "./service_panel";
import { SIMULATION_PANEL } from "./simulation_panel";
import { TOPICS_PANEL } from "./topics_panel";
import { TURTLESIM_PANEL } from "./turtlesim_panel";

export const PANELS: readonly PanelType[] = [
  SCENE_PANEL,
  DISPLAYS_PANEL,
  TOPICS_PANEL,
  MESSAGE_PANEL,
  PLOT_PANEL,
  IMAGE_PANEL,
  LOG_PANEL,
  GRAPH_PANEL,
  SERVICE_PANEL,
  PUBLISH_PANEL,
  SIMULATION_PANEL,
  JOINTS_PANEL,
  TURTLESIM_PANEL,
];
