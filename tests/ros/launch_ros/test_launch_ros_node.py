"""The node action: what it puts on a node's command line."""

import itertools
import os
import pathlib
import re
import sys
import types

import pytest
import yaml
from launch import LaunchContext, LaunchDescription, LaunchService
from launch.actions import GroupAction, SetEnvironmentVariable, SetLaunchConfiguration
from launch.substitutions import LaunchConfiguration, SubstitutionFailure, TextSubstitution
from launch.utilities import perform_substitutions, visit_all_entities_and_collect_futures
from launch_ros.actions import (
    Node,
    PushROSNamespace,
    PushRosNamespace,
    SetParameter,
    SetParametersFromFile,
    SetRemap,
    SetROSLogDir,
    _node_extension,
)
from launch_ros.parameter_descriptions import Parameter, ParameterFile, ParameterValue
from launch_ros.substitutions import ExecutableInPackage, FindPackagePrefix, FindPackageShare
from launch_ros.substitutions import Parameter as ParameterSubstitution

SHOW = "import sys; print('ARGS', sys.argv[1:])"


@pytest.fixture
def context():
    context = LaunchContext()
    context.launch_configurations["x"] = "X"
    return context


@pytest.fixture
def show_arguments(monkeypatch):
    """Replace every executable by a program that prints its arguments."""
    module = types.ModuleType("daidalos.workspaces.executables")

    def find_executable(package, executable):
        if package != "pkg":
            raise LookupError(f"Package '{package}' not found")
        return [sys.executable, "-u", "-c", SHOW]

    module.find_executable = find_executable
    monkeypatch.setitem(sys.modules, "daidalos.workspaces.executables", module)


def command_line(context, node):
    node._perform_substitutions(context)
    return [perform_substitutions(context, word) for word in node.cmd][1:]


def make(**kwargs):
    return Node(package="pkg", executable="exe", **kwargs)


def params(arguments):
    files = [value for option, value in itertools.pairwise(arguments) if option == "--params-file"]
    return [yaml.safe_load(pathlib.Path(file).read_text(encoding="utf-8")) for file in files]


# Names ------------------------------------------------------------------------------------------------


def test_nothing_said(context):
    node = make()
    assert command_line(context, node) == ["--ros-args"]
    assert node.node_name == "<node_namespace_unspecified>/<node_name_unspecified>"
    assert not node.is_node_name_fully_specified()
    assert node.expanded_remapping_rules == []
    assert [part.text for part in node.node_package] == ["pkg"]
    assert [part.text for part in node.node_executable] == ["exe"]


def test_before_execution():
    with pytest.raises(RuntimeError, match="before executing"):
        _ = make(name="n").node_name


@pytest.mark.parametrize(
    ("pushed", "namespace", "expected"),
    [
        ([], None, None),
        ([], "ns", "/ns"),
        ([], "/ns", "/ns"),
        ([], "", "/"),
        ([], "a/b", "/a/b"),
        (["p"], None, "/p"),
        (["p"], "ns", "/p/ns"),
        (["p"], "", "/p"),
        (["p"], "/ns", "/ns"),
        (["p", "q"], "ns", "/p/q/ns"),
        (["p", "/q"], "ns", "/q/ns"),
        (["/p/"], "ns", "/p/ns"),
        (["/"], "ns", "/ns"),
        ([""], "ns", "/ns"),
    ],
)
def test_namespaces(context, pushed, namespace, expected):
    for name in pushed:
        PushROSNamespace(name).visit(context)
    node = make(name="n", namespace=namespace)
    arguments = command_line(context, node)
    if expected is None:
        assert not any("__ns" in argument for argument in arguments)
        assert node.node_name == "<node_namespace_unspecified>/n"
    else:
        assert f"__ns:={expected}" in arguments
        assert node.expanded_node_namespace == expected
        assert node.node_name == f"{expected.rstrip('/')}/n"
        assert node.is_node_name_fully_specified()
    assert arguments[:3] == ["--ros-args", "-r", "__node:=n"]


def test_names_from_substitutions(context):
    node = make(name=["n_", LaunchConfiguration("x")], namespace=[LaunchConfiguration("x")])
    command_line(context, node)
    assert node.node_name == "/X/n_X"
    assert PushRosNamespace is PushROSNamespace


@pytest.mark.parametrize("kwargs", [{"name": "bad name"}, {"name": "a/b"}, {"namespace": "1a"}, {"namespace": "a//b"}])
def test_bad_names(context, kwargs):
    with pytest.raises(SubstitutionFailure, match="malformed"):
        command_line(context, make(**kwargs))


def test_namespaces_end_with_their_scope(context):
    seen = []

    class Look(Node):
        def execute(self, context):
            self._perform_substitutions(context)
            seen.append(self.expanded_node_namespace)

    def look():
        return Look(package="pkg", executable="exe", namespace="n")

    tree = LaunchDescription(
        [
            GroupAction([PushROSNamespace("a"), GroupAction([PushROSNamespace("b"), look()]), look()]),
            look(),
        ]
    )
    visit_all_entities_and_collect_futures(tree, context)
    assert seen == ["/a/b/n", "/a/n", "/n"]


# Arguments --------------------------------------------------------------------------------------------


def test_arguments(context):
    node = make(arguments=["-a", [LaunchConfiguration("x"), "b"]], ros_arguments=["--log-level", "debug"])
    assert command_line(context, node) == ["-a", "Xb", "--ros-args", "--log-level", "debug", "--", "--ros-args"]


def test_remappings(context):
    SetRemap("a", ["b_", LaunchConfiguration("x")]).visit(context)
    node = make(remappings=[("c", "d"), (["e"], [LaunchConfiguration("x")])])
    assert command_line(context, node)[1:] == ["-r", "a:=b_X", "-r", "c:=d", "-r", "e:=X"]
    assert node.expanded_remapping_rules == [("a", "b_X"), ("c", "d"), ("e", "X")]
    for wrong in (["a"], [("a",)], 5):
        with pytest.raises(TypeError):
            make(remappings=wrong)


def test_remappings_end_with_their_scope(context):
    SetRemap("a", "b").visit(context)
    visit_all_entities_and_collect_futures(GroupAction([SetRemap("c", "d")]), context)
    assert context.launch_configurations["ros_remaps"] == [("a", "b")]


def test_parameters(context, tmp_path):
    file = tmp_path / "a.yaml"
    file.write_text("/**: {ros__parameters: {x: $(var x)}}")
    node = make(
        name="n",
        namespace="ns",
        parameters=[
            {"a": 1, "nested": {"b": [LaunchConfiguration("x")]}},
            str(file),
            ParameterFile(file, allow_substs=True),
            Parameter("single", 5),
            {"description": ParameterValue("<a: b> # c", value_type=str), "y": "y", "e": "1e5"},
        ],
    )
    arguments = command_line(context, node)
    first, plain, replaced, last = params(arguments)
    assert first == {"/ns/n": {"ros__parameters": {"a": 1, "nested.b": "X"}}}
    assert plain == yaml.safe_load(file.read_text())
    assert replaced == {"/**": {"ros__parameters": {"x": "X"}}}
    assert last["/ns/n"]["ros__parameters"] == {"description": "<a: b> # c", "y": "y", "e": "1e5"}
    assert arguments[arguments.index("-p") + 1] == "single:=5"
    assert [is_file for _, is_file in node._Node__expanded_parameter_arguments] == [True, True, True, False, True]


def test_texts_are_quoted_for_other_readers(context):
    arguments = command_line(context, make(parameters=[{"a": "y", "b": ["on", "1e5"]}]))
    text = pathlib.Path(arguments[-1]).read_text(encoding="utf-8")
    for quoted in ("'y'", "'on'", "'1e5'"):
        assert quoted in text
    assert "/**" in yaml.safe_load(text)


def test_parameter_files_last_as_long_as_the_program():
    import subprocess

    program = """
from launch import LaunchContext
from launch_ros.actions import Node
node = Node(package='p', executable='e', parameters=[{'a': 1}])
node._perform_substitutions(LaunchContext())
print(node._Node__expanded_parameter_arguments[0][0])
open(node._Node__expanded_parameter_arguments[0][0]).close()
"""
    path = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True).stdout.strip()
    assert "launch_params_" in path
    assert not os.path.exists(path)


def test_missing_parameter_file(context, capsys):
    assert command_line(context, make(parameters=["/no/such/file.yaml"])) == ["--ros-args"]
    assert "Parameter file path is not a file: /no/such/file.yaml" in capsys.readouterr().out


@pytest.mark.parametrize("wrong", [{"a": 1}, "file", [5], [{"a": None}], [{5: 1}]])
def test_wrong_parameters(wrong):
    with pytest.raises(TypeError):
        make(parameters=wrong)


def test_parameters_for_all(context, tmp_path):
    file = tmp_path / "a.yaml"
    file.write_text("/**: {ros__parameters: {x: 1}}")
    SetParameter("use_sim_time", LaunchConfiguration("sim", default="true")).visit(context)
    SetParametersFromFile([str(tmp_path), "/a.yaml"]).visit(context)
    SetParameter(["name_", LaunchConfiguration("x")], ParameterValue("1", value_type=str)).visit(context)
    assert context.launch_configurations["global_params"] == [("use_sim_time", True), str(file), ("name_X", "1")]
    arguments = command_line(context, make(parameters=[{"own": 1}]))
    assert arguments[1:7] == ["-p", "use_sim_time:=true", "--params-file", str(file), "-p", "name_X:='1'"]
    assert arguments[7] == "--params-file"
    assert ParameterSubstitution("use_sim_time").perform(context) == "True"
    assert ParameterSubstitution("unknown", default="d").perform(context) == "d"
    with pytest.raises(SubstitutionFailure, match="'unknown' not found"):
        ParameterSubstitution("unknown").perform(context)


def test_simple_parameters_are_readable(context):
    SetParameter("my_param", "my_value").visit(context)
    assert context.launch_configurations["global_params"] == [("my_param", "my_value")]
    arguments = command_line(context, make(parameters=[{"asd": "bsd"}]))
    assert arguments.count("-p") == 1
    assert arguments[arguments.index("-p") + 1] == "my_param:=my_value"


def test_long_parameters_go_into_files(context):
    text = "<robot>" + "x" * 200_000 + "</robot>"
    SetParameter("robot_description", ParameterValue(text, value_type=str)).visit(context)
    [content] = params(command_line(context, make()))
    assert content["/**"]["ros__parameters"]["robot_description"] == text


def test_parameters_end_with_their_scope(context):
    visit_all_entities_and_collect_futures(GroupAction([SetParameter("a", 1)]), context)
    assert "global_params" not in context.launch_configurations


def test_log_dir(context):
    visit_all_entities_and_collect_futures(GroupAction([SetROSLogDir(["/logs/", LaunchConfiguration("x")])]), context)
    assert os.environ["ROS_LOG_DIR"] != "/logs/X"
    SetROSLogDir(["/logs/", LaunchConfiguration("x")]).visit(context)
    assert os.environ["ROS_LOG_DIR"] == "/logs/X"


# Packages ---------------------------------------------------------------------------------------------


@pytest.fixture
def package(tmp_path, monkeypatch):
    prefix = tmp_path / "prefix"
    (prefix / "share" / "ament_index" / "resource_index" / "packages").mkdir(parents=True)
    (prefix / "share" / "ament_index" / "resource_index" / "packages" / "pkg").touch()
    (prefix / "share" / "pkg").mkdir()
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(prefix))
    return prefix


def test_finding_packages(context, package):
    assert FindPackagePrefix("pkg").perform(context) == str(package)
    assert FindPackageShare(["p", TextSubstitution(text="kg")]).perform(context) == str(package / "share" / "pkg")
    assert (FindPackageShare("pkg") / "launch" / "a.py").perform(context) == str(package / "share/pkg/launch/a.py")
    assert "'pkg'" in FindPackageShare("pkg").describe()
    with pytest.raises(SubstitutionFailure, match=r"package 'pkgg' not found.*did you mean 'pkg'"):
        FindPackageShare("pkgg").perform(context)


def test_finding_executables(context, package):
    with pytest.raises(SubstitutionFailure, match=r"libexec directory .* does not exist"):
        ExecutableInPackage("exe", "pkg").perform(context)
    folder = package / "lib" / "pkg"
    folder.mkdir(parents=True)
    with pytest.raises(SubstitutionFailure, match="executable 'exe' not found on the libexec directory"):
        ExecutableInPackage("exe", "pkg").perform(context)
    (folder / "exe").touch(mode=0o755)
    assert ExecutableInPackage("exe", "pkg").perform(context) == str(folder / "exe")
    assert "'exe'" in ExecutableInPackage("exe", "pkg").describe()


# Running ----------------------------------------------------------------------------------------------


def run(*entities, expected=0):
    service = LaunchService()
    service.include_launch_description(LaunchDescription(list(entities)))
    assert service.run() == expected
    return service


def test_running(show_arguments, capsys):
    node = make(name="n", arguments=["-a"], output="screen")
    run(node)
    printed = capsys.readouterr().out
    assert re.search(r"\[exe-\d+\] ARGS \['-a', '--ros-args', '-r', '__node:=n'\]", printed)
    assert node.process_details["cmd"][0] == sys.executable
    assert "rclpy" not in repr(node.process_details)


def test_process_names_and_environment(show_arguments, capsys):
    run(SetEnvironmentVariable("A", "1"), make(exec_name=["my_", "exec"], output="screen"))
    assert re.search(r"\[my_exec-\d+\] ARGS", capsys.readouterr().out)


def test_paths_instead_of_packages(capsys):
    run(Node(executable=sys.executable, arguments=["-c", SHOW], output="screen"))
    assert "ARGS ['--ros-args']" in capsys.readouterr().out


def test_prefix_filters_go_by_the_executables_name(show_arguments, capsys):
    prefix = f"{sys.executable} -c 'print(\"PREFIX\")'"
    for pattern, expected in (("exe", "PREFIX"), ("python", "ARGS")):
        run(
            SetLaunchConfiguration("launch-prefix", prefix),
            SetLaunchConfiguration("launch-prefix-filter", pattern),
            make(output="screen"),
        )
        assert expected in capsys.readouterr().out


def test_unknown_package(show_arguments):
    service = run(Node(package="nothing", executable="exe"), expected=1)
    assert service.error.reason == "Package 'nothing' not found"


def test_nodes_of_one_name_are_mentioned(show_arguments, capsys):
    run(make(name="n", namespace="/"), make(name="n", namespace="/"), make(name="m", namespace="/"))
    printed = capsys.readouterr().out
    assert printed.count("nodes with the name /n created") == 1
    assert "/m created" not in printed


def test_extensions(show_arguments, monkeypatch, capsys):
    class Extension(_node_extension.NodeActionExtension):
        def prepare_for_execute(self, context, ros_specific_arguments, node_action):
            assert node_action.node_name.endswith("/n")
            return ["--from-extension", [self.NAME]], ros_specific_arguments

    class Broken(_node_extension.NodeActionExtension):
        def __init__(self):
            raise RuntimeError("broken")

    monkeypatch.setattr(_node_extension, "_extension_classes", {"mine": Extension, "broken": Broken})
    run(make(name="n", output="screen"))
    printed = capsys.readouterr().out
    assert "'--from-extension', 'mine']" in printed
    assert "Exception instantiating extension 'launch_ros.node_action.broken': broken" in printed


# Markup -----------------------------------------------------------------------------------------------


def test_xml(show_arguments, run_text, capsys, tmp_path):
    (tmp_path / "a.yaml").write_text("/**: {ros__parameters: {file: $(var v)}}")
    run_text(
        f"""
        <launch>
            <let name="v" value="V"/>
            <set_parameter name="all" value="$(var v)"/>
            <set_remap from="g" to="h"/>
            <group>
            <push_ros_namespace namespace="pushed"/>
            <node pkg="pkg" exec="exe" name="n" namespace="ns" exec_name="proc" output="screen"
                args="-a '$(var v) b' c$(var v)" ros_args="--log-level warn">
                <param name="i" value="1"/>
                <param name="s" value="1" type="str"/>
                <param name="l" value="1;2" value-sep=";"/>
                <param name="sub" value="$(eval '1 + 1')"/>
                <param name="outer"><param name="inner"><param name="p" value="1.5"/></param></param>
                <param from="{tmp_path}/a.yaml" allow_substs="true"/>
                <remap from="a" to="$(var v)"/>
                <env name="A" value="b"/>
            </node>
            </group>
        </launch>
        """
    )
    printed = capsys.readouterr().out
    arguments = yaml.safe_load(re.search(r"\[proc-\d+\] ARGS (.*)", printed)[1])
    assert arguments[:10] == [
        "-a",
        "V b",
        "cV",
        "--ros-args",
        "--log-level",
        "warn",
        "--",
        "--ros-args",
        "-r",
        "__node:=n",
    ]
    assert "__ns:=/pushed/ns" in arguments
    assert arguments[-4:] == ["-r", "g:=h", "-r", "a:=V"]
    assert "all:=V" in arguments
    merged = {}
    for content in params(arguments):
        for section in content.values():
            merged.update(section["ros__parameters"])
    assert merged == {"i": 1, "s": "1", "l": [1, 2], "sub": 2, "outer.inner.p": 1.5, "file": "V"}


def test_yaml(show_arguments, run_text, capsys):
    run_text(
        """
        launch:
        - push_ros_namespace: {namespace: pushed}
        - set_parameters_from_file: {filename: /no/such/file.yaml}
        - set_ros_log_dir: {new_log_dir: /tmp}
        - node:
            pkg: pkg
            exec: exe
            name: n
            output: screen
            param:
            - {name: i, value: 1}
            - {name: f, value: [1.5, 2.5]}
            - {name: s, value: ['a', '$(eval 1)b']}
            - name: outer
              param: [{name: inner, value: true}]
            remap: [{from: a, to: b}]
        """
    )
    arguments = yaml.safe_load(re.search(r"\[exe-\d+\] ARGS (.*)", capsys.readouterr().out)[1])
    merged = {}
    for content in params(arguments):
        merged.update(content["/pushed/n"]["ros__parameters"])
    assert merged == {"i": 1, "f": [1.5, 2.5], "s": ["a", "1b"], "outer.inner": True}


@pytest.mark.parametrize(
    ("inside", "reason"),
    [
        ("<param name='a'/>", "must have either 'value' or elements 'param'"),
        ("<param value='a'/>", "must have either 'name' or 'from'"),
        ("<param name='a' from='b'/>", "must have either 'name' or 'from'"),
        ("<param name='a' value='1' colour='red'/>", "colour"),
        ("<param name='a' value='x' type='int'/>", "expected int, but got 'x'"),
        ("<param name='a' value='1' type='number'/>", "unknown type 'number'"),
        ("<param name='a'><param from='b'/></param>", "there can be no files"),
        ("<remap from='a'/>", "`to` is missing in `remap`"),
        ("<remap from='a' to='b' if='1'/>", "if"),
    ],
)
def test_mistakes_in_markup(show_arguments, tmp_path, inside, reason):
    from launch.actions import IncludeLaunchDescription

    path = tmp_path / "a.launch.xml"
    path.write_text(f"<launch>\n<node pkg='pkg' exec='exe'>{inside}</node></launch>")
    service = run(IncludeLaunchDescription(str(path)), expected=1)
    assert (service.error.file, service.error.line) == (str(path), 2)
    assert reason in service.error.reason


def test_an_executable_without_a_package(run_text, capsys):
    run_text(f"<launch><node exec='{sys.executable}' args=\"-c 'print(5 * 7)'\" output='screen'/></launch>")
    assert "] 35" in capsys.readouterr().out


def test_a_relative_log_folder_is_below_the_present_one(context, monkeypatch, tmp_path):
    monkeypatch.setenv("ROS_LOG_DIR", str(tmp_path))
    SetROSLogDir("inner").visit(context)
    assert context.environment["ROS_LOG_DIR"] == str(tmp_path / "inner")
