/* The arena of each thread, made at its first call. */
static _Thread_local _Alignas(16) char arena_memory[1 << 18];
static _Thread_local struct arena arena_own;

static inline struct arena *arena_here(void)
{
    if (!arena_own.end) {
        arena_own.top = arena_memory;
        arena_own.end = arena_memory + sizeof arena_memory;
    }
    return &arena_own;
}

/* Set where a function of a user's, written in Python, has raised an error. */
static int64_t failed;

static int raise_failure(void)
{
    PyObject *library = PyImport_ImportModule("iiwa_dnn.compiling.library");
    PyObject *done = library ? PyObject_CallMethod(library, "raise_failure", NULL) : NULL;
    Py_XDECREF(library);
    Py_XDECREF(done);
    return done == NULL;
}

static inline bool counted(const char *name, Py_ssize_t count, Py_ssize_t expected)
{
    if (count == expected) return true;
    PyErr_Format(PyExc_TypeError, "%s takes %zd arguments, not %zd", name, expected, count);
    return false;
}

static inline void *read_array(
    PyObject *object, int axes, int type, const char *word, int64_t *size, bool writes)
{
    PyArrayObject *array = (PyArrayObject *)object;
    if (!PyArray_Check(object) || PyArray_NDIM(array) != axes || PyArray_TYPE(array) != type
        || !PyArray_IS_C_CONTIGUOUS(array) || !PyArray_ISALIGNED(array)) {
        PyErr_Format(PyExc_TypeError, "%R is no array of %s of %d axes without gaps", object, word, axes);
        return NULL;
    }
    if (writes && !PyArray_ISWRITEABLE(array)) {
        PyErr_SetString(PyExc_TypeError, "an array that is written into is read-only");
        return NULL;
    }
    for (int i = 0; i < axes; i++) size[i] = PyArray_DIM(array, i);
    return PyArray_DATA(array);
}

static inline double *read_doubles(PyObject *object, int axes, int64_t *size, bool writes)
{
    return read_array(object, axes, NPY_DOUBLE, "float64", size, writes);
}

static inline bool has_size(const char *record, int64_t size, int64_t fixed, int64_t shared)
{
    const int64_t rest = size - fixed;
    if (rest >= 0 && (shared ? rest % shared == 0 : rest == 0)) return true;
    PyErr_Format(PyExc_ValueError, "an array of %lld numbers is no %s", (long long)size, record);
    return false;
}

static inline int64_t *read_ints(PyObject *object, int axes, int64_t *size, bool writes)
{
    return read_array(object, axes, NPY_INT64, "int64", size, writes);
}

static inline bool read_double(PyObject *object, double *value)
{
    *value = PyFloat_AsDouble(object);
    return *value != -1.0 || !PyErr_Occurred();
}

static inline bool read_int(PyObject *object, int64_t *value)
{
    *value = PyLong_AsLongLong(object);
    return *value != -1 || !PyErr_Occurred();
}

static inline bool read_bool(PyObject *object, bool *value)
{
    const int is_true = PyObject_IsTrue(object);
    *value = is_true > 0;
    return is_true >= 0;
}

static inline bool is_tuple(PyObject *object, Py_ssize_t size)
{
    if (PyTuple_Check(object) && PyTuple_GET_SIZE(object) == size) return true;
    PyErr_Format(PyExc_TypeError, "%R is no tuple of %zd", object, size);
    return false;
}

/* Whether a tuple is the one that was read last: then its struct is that of then. */
static inline bool is_seen(PyObject *object, PyObject **seen, void *value, const void *kept, size_t size)
{
    if (object != *seen) return false;
    memcpy(value, kept, size);
    return true;
}

static inline bool keep(PyObject *object, PyObject **seen, const void *value, void *kept, size_t size)
{
    PyObject *before = *seen;
    memcpy(kept, value, size);
    *seen = Py_NewRef(object);
    Py_XDECREF(before);
    return true;
}


struct kernel { const char *name, *code; long number; };
