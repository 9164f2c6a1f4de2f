# Components: libraries of nodes, and a program for each that runs it alone.
include_guard(GLOBAL)
if(NOT TARGET rclcpp_components::component)
  add_library(rclcpp_components::component INTERFACE IMPORTED GLOBAL)
  target_link_libraries(rclcpp_components::component INTERFACE rclcpp_components::rclcpp_components)
endif()

# Write the program of a component, and link and install it. The library registers the component when it is loaded.
function(rclcpp_components_register_node target)
  cmake_parse_arguments(ARG "" "PLUGIN;EXECUTABLE;EXECUTOR;RESOURCE_INDEX" "" ${ARGN})
  if(NOT ARG_PLUGIN OR NOT ARG_EXECUTABLE)
    message(FATAL_ERROR "rclcpp_components_register_node(${target}): expected PLUGIN and EXECUTABLE")
  endif()
  if(NOT ARG_EXECUTOR)
    set(ARG_EXECUTOR SingleThreadedExecutor)
  endif()
  set(source "${CMAKE_CURRENT_BINARY_DIR}/daidalos_components/${ARG_EXECUTABLE}.cpp")
  file(CONFIGURE OUTPUT "${source}" @ONLY CONTENT [[
#include "rclcpp_components/register_node_macro.hpp"

int main(int argc, char ** argv)
{
  rclcpp::init(argc, argv);
  const auto found = rclcpp_components::factories().find("@ARG_PLUGIN@");
  if (found == rclcpp_components::factories().end()) {
    RCLCPP_FATAL(
      rclcpp::get_logger("@ARG_EXECUTABLE@"), "no library registers '@ARG_PLUGIN@' by RCLCPP_COMPONENTS_REGISTER_NODE");
    return 1;
  }
  const auto made = found->second(rclcpp::NodeOptions());
  rclcpp::executors::@ARG_EXECUTOR@ executor;
  executor.add_node(made.base);
  executor.spin();
  rclcpp::shutdown();
}
]])
  add_executable(${ARG_EXECUTABLE} "${source}")
  target_link_libraries(${ARG_EXECUTABLE} rclcpp_components::component)
  if(UNIX AND NOT APPLE)
    # The program uses no symbol of the library, which a linker may take for a reason not to load it.
    target_link_options(${ARG_EXECUTABLE} PRIVATE "LINKER:--no-as-needed")
  endif()
  target_link_libraries(${ARG_EXECUTABLE} ${target})
  install(TARGETS ${ARG_EXECUTABLE} DESTINATION lib/${PROJECT_NAME})
endfunction()

# Components for containers only. No container loads components in C++, which is said when the package is configured.
function(rclcpp_components_register_nodes target)
  message(WARNING "${PROJECT_NAME}: no container loads ${ARGN}; rclcpp_components_register_node makes programs of them")
endfunction()
