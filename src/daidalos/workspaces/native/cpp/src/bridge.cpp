#include "daidalos/bridge.hpp"

#include <cstring>
#include <mutex>

#include "python_api.hpp"

namespace daidalos
{
namespace
{
using python::Lock;
using python::Ref;

const char kCapsule[] = "daidalos.callback";

PyObject * to_python(const Value & value);
Value from_python(PyObject * object);

Object keep(PyObject * new_reference)
{
  return Object(new_reference, [](void * object) {
        Lock lock;
        python::Py_DecRef(static_cast<PyObject *>(object));
      });
}

std::string text_of(PyObject * object)
{
  Ref text(python::PyObject_Str(object));
  Ref bytes(text ? python::PyUnicode_AsUTF8String(text.get()) : nullptr);
  char * data = nullptr;
  Py_ssize_t size = 0;
  if (!bytes || python::PyBytes_AsStringAndSize(bytes.get(), &data, &size)) {
    python::PyErr_Clear();
    return "?";
  }
  return std::string(data, size);
}

[[noreturn]] void raise()
{
  PyObject * type = nullptr, * value = nullptr, * trace = nullptr;
  python::PyErr_Fetch(&type, &value, &trace);
  python::PyErr_NormalizeException(&type, &value, &trace);
  Ref holds_type(type), holds_value(value), holds_trace(trace);
  Ref name(python::PyObject_GetAttrString(type, "__name__"));
  throw PythonError(name ? text_of(name.get()) : "?", value ? text_of(value) : "");
}

PyObject * checked(PyObject * object)
{
  if (!object) {
    raise();
  }
  return object;
}

/// Called by Python: run the function behind the capsule without Python's lock.
PyObject * run_callback(PyObject * capsule, PyObject * arguments)
{
  auto * function = static_cast<Callback *>(python::PyCapsule_GetPointer(capsule, kCapsule));
  try {
    const Callback held = *function;
    List values = std::get<List>(from_python(arguments));
    Value result;
    {
      struct Free
      {
        void * state = python::PyEval_SaveThread();
        ~Free() {python::PyEval_RestoreThread(state);}
      } free;
      result = (*held)(std::move(values));
    }
    return to_python(result);
  } catch (const std::exception & error) {
    python::PyErr_SetString(python::runtime_error, error.what());
    return nullptr;
  }
}

PyObject * to_python(const Callback & function)
{
  static PyMethodDef method = {"callback", run_callback, python::kVarArgs, nullptr};
  Ref capsule(python::PyCapsule_New(new Callback(function), kCapsule, [](PyObject * object) {
      delete static_cast<Callback *>(python::PyCapsule_GetPointer(object, kCapsule));
    }));
  return python::PyCFunction_NewEx(&method, capsule.get(), nullptr);
}

PyObject * to_python(const List & values)
{
  PyObject * list = checked(python::PyList_New(static_cast<Py_ssize_t>(values.size())));
  for (std::size_t i = 0; i != values.size(); ++i) {
    python::PyList_SetItem(list, static_cast<Py_ssize_t>(i), to_python(values[i]));
  }
  return list;
}

PyObject * to_python(const Value & value)
{
  return std::visit([](const auto & held) -> PyObject * {
             using T = std::decay_t<decltype(held)>;
             if constexpr (std::is_same<T, std::monostate>::value) {
               python::Py_IncRef(python::none);
               return python::none;
             } else if constexpr (std::is_same<T, bool>::value) {
               return python::PyBool_FromLong(held);
             } else if constexpr (std::is_same<T, std::int64_t>::value) {
               return python::PyLong_FromLongLong(held);
             } else if constexpr (std::is_same<T, double>::value) {
               return python::PyFloat_FromDouble(held);
             } else if constexpr (std::is_same<T, std::string>::value) {
               return python::PyUnicode_DecodeUTF8(held.data(), static_cast<Py_ssize_t>(held.size()), "replace");
             } else if constexpr (std::is_same<T, Blob>::value) {
               return python::PyBytes_FromStringAndSize(held.data.data(), static_cast<Py_ssize_t>(held.data.size()));
             } else if constexpr (std::is_same<T, Object>::value) {
               PyObject * object = held ? static_cast<PyObject *>(held.get()) : python::none;
               python::Py_IncRef(object);
               return object;
             } else {
               return to_python(held);
             }
           }, static_cast<const Value::variant &>(value));
}

Value from_python(PyObject * object)
{
  if (object == python::none) {
    return Value();
  }
  Ref type(python::PyObject_Type(object));
  const PyObject * kind = type.get();
  if (kind == python::bool_type) {
    return Value(python::PyLong_AsLongLong(object) != 0);
  }
  if (kind == python::int_type) {
    return Value(static_cast<std::int64_t>(python::PyLong_AsLongLong(object)));
  }
  if (kind == python::float_type) {
    return Value(python::PyFloat_AsDouble(object));
  }
  if (kind == python::str_type) {
    return Value(text_of(object));
  }
  if (kind == python::bytes_type) {
    char * data = nullptr;
    Py_ssize_t size = 0;
    python::PyBytes_AsStringAndSize(object, &data, &size);
    return Value(Blob{Bytes(data, size)});
  }
  if (kind == python::list_type || kind == python::tuple_type) {
    List values(python::PySequence_Size(object));
    for (std::size_t i = 0; i != values.size(); ++i) {
      Ref item(python::PySequence_GetItem(object, static_cast<Py_ssize_t>(i)));
      values[i] = from_python(item.get());
    }
    return Value(std::move(values));
  }
  python::Py_IncRef(object);
  return Value(keep(object));
}
}  // namespace

Callback callback(std::function<Value(List)> function)
{
  return std::make_shared<std::function<Value(List)>>(std::move(function));
}

Object door()
{
  static std::once_flag once;
  static Object * module = nullptr;  // never released: Python outlives what is static
  std::call_once(once, [] {
      python::start();
      Lock lock;
      module = new Object(keep(checked(python::PyImport_ImportModule("daidalos.native.door"))));
    });
  return *module;
}

Value call(const Object & object, const char * method, const List & arguments)
{
  Lock lock;
  Ref function(checked(python::PyObject_GetAttrString(static_cast<PyObject *>(object.get()), method)));
  Ref given(checked(python::PyTuple_New(static_cast<Py_ssize_t>(arguments.size()))));
  for (std::size_t i = 0; i != arguments.size(); ++i) {
    python::PyTuple_SetItem(given.get(), static_cast<Py_ssize_t>(i), to_python(arguments[i]));
  }
  Ref result(checked(python::PyObject_CallObject(function.get(), given.get())));
  return from_python(result.get());
}

void send(const Object & bound_method, const Bytes & data)
{
  Lock lock;
  Ref bytes(checked(python::PyBytes_FromStringAndSize(data.data(), static_cast<Py_ssize_t>(data.size()))));
  Ref result(checked(python::PyObject_CallFunctionObjArgs(
      static_cast<PyObject *>(bound_method.get()), bytes.get(), static_cast<PyObject *>(nullptr))));
}

Object attribute(const Object & object, const char * name)
{
  Lock lock;
  return keep(checked(python::PyObject_GetAttrString(static_cast<PyObject *>(object.get()), name)));
}
}  // namespace daidalos
