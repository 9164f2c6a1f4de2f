// The functions of Python's stable ABI that the bridge calls, found in libpython when the process needs them.
//
// They are declared here, so that neither Python's headers nor one build for each version of Python are needed.
#ifndef PYTHON_API_HPP_
#define PYTHON_API_HPP_

#include <cstddef>

extern "C" {
typedef struct _object PyObject;
typedef ptrdiff_t Py_ssize_t;
typedef PyObject * (*PyCFunction)(PyObject *, PyObject *);
struct PyMethodDef
{
  const char * name;
  PyCFunction function;
  int flags;
  const char * doc;
};
}

namespace python
{
constexpr int kVarArgs = 1;
constexpr int kFileInput = 257;

#define DAIDALOS_PYTHON_FUNCTIONS(F) \
  F(void, Py_InitializeEx, (int)) \
  F(int, Py_IsInitialized, ()) \
  F(void *, PyEval_SaveThread, ()) \
  F(void, PyEval_RestoreThread, (void *)) \
  F(int, PyGILState_Ensure, ()) \
  F(void, PyGILState_Release, (int)) \
  F(void, Py_IncRef, (PyObject *)) \
  F(void, Py_DecRef, (PyObject *)) \
  F(PyObject *, PyImport_ImportModule, (const char *)) \
  F(PyObject *, PyImport_AddModule, (const char *)) \
  F(PyObject *, PyModule_GetDict, (PyObject *)) \
  F(PyObject *, Py_CompileString, (const char *, const char *, int)) \
  F(PyObject *, PyEval_EvalCode, (PyObject *, PyObject *, PyObject *)) \
  F(PyObject *, PyObject_GetAttrString, (PyObject *, const char *)) \
  F(PyObject *, PyObject_CallObject, (PyObject *, PyObject *)) \
  F(PyObject *, PyObject_CallFunctionObjArgs, (PyObject *, ...)) \
  F(PyObject *, PyObject_Str, (PyObject *)) \
  F(PyObject *, PyObject_Type, (PyObject *)) \
  F(int, PyObject_IsInstance, (PyObject *, PyObject *)) \
  F(PyObject *, PyBool_FromLong, (long)) \
  F(PyObject *, PyLong_FromLongLong, (long long)) \
  F(long long, PyLong_AsLongLong, (PyObject *)) \
  F(PyObject *, PyFloat_FromDouble, (double)) \
  F(double, PyFloat_AsDouble, (PyObject *)) \
  F(PyObject *, PyUnicode_DecodeUTF8, (const char *, Py_ssize_t, const char *)) \
  F(PyObject *, PyUnicode_AsUTF8String, (PyObject *)) \
  F(PyObject *, PyBytes_FromStringAndSize, (const char *, Py_ssize_t)) \
  F(int, PyBytes_AsStringAndSize, (PyObject *, char **, Py_ssize_t *)) \
  F(PyObject *, PyList_New, (Py_ssize_t)) \
  F(int, PyList_SetItem, (PyObject *, Py_ssize_t, PyObject *)) \
  F(PyObject *, PyTuple_New, (Py_ssize_t)) \
  F(int, PyTuple_SetItem, (PyObject *, Py_ssize_t, PyObject *)) \
  F(Py_ssize_t, PySequence_Size, (PyObject *)) \
  F(PyObject *, PySequence_GetItem, (PyObject *, Py_ssize_t)) \
  F(PyObject *, PyCapsule_New, (void *, const char *, void (*)(PyObject *))) \
  F(void *, PyCapsule_GetPointer, (PyObject *, const char *)) \
  F(PyObject *, PyCFunction_NewEx, (PyMethodDef *, PyObject *, PyObject *)) \
  F(void, PyErr_SetString, (PyObject *, const char *)) \
  F(PyObject *, PyErr_Occurred, ()) \
  F(void, PyErr_Fetch, (PyObject **, PyObject **, PyObject **)) \
  F(void, PyErr_NormalizeException, (PyObject **, PyObject **, PyObject **)) \
  F(void, PyErr_Clear, ())

#define DAIDALOS_DECLARE(result, name, parameters) extern result(*name) parameters;
DAIDALOS_PYTHON_FUNCTIONS(DAIDALOS_DECLARE)
#undef DAIDALOS_DECLARE

extern PyObject * none;
extern PyObject * bool_type;
extern PyObject * int_type;
extern PyObject * float_type;
extern PyObject * str_type;
extern PyObject * bytes_type;
extern PyObject * list_type;
extern PyObject * tuple_type;
extern PyObject * runtime_error;

/// Load libpython, start the interpreter and run the start-up text of the prefix.
void start();

/// Python's lock, held for the life of the object. The thread's state is kept until the thread ends.
class Lock
{
public:
  Lock();
  ~Lock();
  Lock(const Lock &) = delete;
  Lock & operator=(const Lock &) = delete;

private:
  int state_;
};

/// A new reference, dropped at the end of a scope; Python's lock must be held.
class Ref
{
public:
  explicit Ref(PyObject * object = nullptr) : object_(object) {}
  ~Ref()
  {
    if (object_) {
      Py_DecRef(object_);
    }
  }
  Ref(const Ref &) = delete;
  Ref & operator=(const Ref &) = delete;
  PyObject * get() const {return object_;}
  PyObject * release() {PyObject * found = object_; object_ = nullptr; return found;}
  explicit operator bool() const {return object_ != nullptr;}

private:
  PyObject * object_;
};
}  // namespace python

#endif
