#include "python_api.hpp"

#include <dlfcn.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

namespace python
{
#define DAIDALOS_DEFINE(result, name, parameters) result(*name) parameters = nullptr;
DAIDALOS_PYTHON_FUNCTIONS(DAIDALOS_DEFINE)
#undef DAIDALOS_DEFINE

PyObject * none;
PyObject * bool_type;
PyObject * int_type;
PyObject * float_type;
PyObject * str_type;
PyObject * bytes_type;
PyObject * list_type;
PyObject * tuple_type;
PyObject * runtime_error;

namespace
{
[[noreturn]] void fail(const std::string & text)
{
  std::fprintf(stderr, "rclcpp: %s\n", text.c_str());
  std::exit(1);
}

/// Folder of the prefix that this library is installed in.
std::string prefix()
{
  Dl_info info;
  if (!dladdr(reinterpret_cast<void *>(&start), &info)) {
    fail("cannot find the folder of its own library");
  }
  const std::string path = info.dli_fname;
  return path.substr(0, path.rfind('/')) + "/..";
}

void * load(const std::string & path)
{
  // Extension modules take Python's symbols from the whole process.
  void * library = path.empty() ? nullptr : dlopen(path.c_str(), RTLD_NOW | RTLD_GLOBAL);
  if (!library) {
    const char * why = dlerror();
    fail(
      "cannot load '" + path + "' (" + (why ? why : "no path") +
      "): build the package again with 'colcon build', which looks for Python's library");
  }
  return library;
}

PyObject * builtin(const char * name)
{
  Ref module(PyImport_ImportModule("builtins"));
  return PyObject_GetAttrString(module.get(), name);
}
}  // namespace

void start()
{
  if (none) {
    return;
  }
  // Two lines (libpython and the home of Python), then what the interpreter runs first.
  std::ifstream file(prefix() + "/python_start.txt");
  std::string library_path, home;
  if (!std::getline(file, library_path) || !std::getline(file, home)) {
    fail("'" + prefix() + "/python_start.txt' cannot be read: build the package again with 'colcon build'");
  }
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  void * library = load(library_path);
#define DAIDALOS_FIND(result, name, parameters) \
  name = reinterpret_cast<result(*) parameters>(dlsym(library, #name)); \
  if (!name) { \
    fail("'" + library_path + "' has no function " #name); \
  }
  DAIDALOS_PYTHON_FUNCTIONS(DAIDALOS_FIND)
#undef DAIDALOS_FIND
  const bool first = !Py_IsInitialized();
  if (first) {
    const char * before = std::getenv("PYTHONHOME");
    const std::string saved = before ? before : "";
    setenv("PYTHONHOME", home.c_str(), 1);
    Py_InitializeEx(0);
    if (before) {
      setenv("PYTHONHOME", saved.c_str(), 1);
    } else {
      unsetenv("PYTHONHOME");
    }
  }
  const int state = first ? 0 : PyGILState_Ensure();
  bool_type = builtin("bool");
  int_type = builtin("int");
  float_type = builtin("float");
  str_type = builtin("str");
  bytes_type = builtin("bytes");
  list_type = builtin("list");
  tuple_type = builtin("tuple");
  runtime_error = builtin("RuntimeError");
  if (first) {
    PyObject * globals = PyModule_GetDict(PyImport_AddModule("__main__"));
    Ref code(Py_CompileString(text.c_str(), "python_start.txt", kFileInput));
    Ref done(code ? PyEval_EvalCode(code.get(), globals, globals) : nullptr);
    if (!done) {
      PyErr_Clear();
      fail("Python did not start: build the package again with 'colcon build'");
    }
  }
  {
    // `None` is data, not a function: the result of a call that returns it.
    Ref empty(PyList_New(0));
    Ref clear(PyObject_GetAttrString(empty.get(), "clear"));
    none = PyObject_CallObject(clear.get(), nullptr);
  }
  if (first) {
    PyEval_SaveThread();
  } else {
    PyGILState_Release(state);
  }
}

Lock::Lock()
{
  // A state that lives as long as the thread is several times faster than one for each call.
  thread_local bool kept = false;
  if (!kept) {
    kept = true;
    const int was_free = PyGILState_Ensure();
    if (was_free) {
      PyEval_SaveThread();
    }
  }
  state_ = PyGILState_Ensure();
}

Lock::~Lock()
{
  PyGILState_Release(state_);
}
}  // namespace python
