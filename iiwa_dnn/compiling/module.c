static int note(PyObject *module, const char *name, const struct kernel *kernel)
{
    PyObject *dict = PyObject_GetAttrString(module, name);
    PyObject *value = name[0] == 'c' ? PyUnicode_FromString(kernel->code)
                                     : PyLong_FromLong(kernel->number);
    const int done = dict && value ? PyDict_SetItemString(dict, kernel->name, value) : -1;
    Py_XDECREF(dict);
    Py_XDECREF(value);
    return done;
}

static struct PyModuleDef definition = {
    .m_base = PyModuleDef_HEAD_INIT,
    .m_name = "iiwa_dnn._kernels",
    .m_doc = "The package's kernels.",
    .m_size = -1,
    .m_methods = methods,
};

PyMODINIT_FUNC PyInit__kernels(void)
{
    import_array();
    PyObject *module = PyModule_Create(&definition);
    if (!module) return NULL;
    if (PyModule_AddObject(module, "numbers", PyDict_New()) < 0
        || PyModule_AddObject(module, "codes", PyDict_New()) < 0
        || PyModule_AddObject(module, "failed", PyLong_FromVoidPtr(&failed)) < 0) return NULL;
    for (const struct kernel *kernel = kernels; kernel->name; kernel++) {
        if (note(module, "codes", kernel) < 0 || note(module, "numbers", kernel) < 0) return NULL;
    }
    return module;
}
