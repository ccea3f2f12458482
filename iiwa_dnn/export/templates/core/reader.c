/* Tables are input: what does not fit, or is large enough that a product of two might overflow, is not read, and
 * the load fails. Kernels do not write into them, though the types of their arrays do not say so. */
struct reader {
    const double *number, *last_number;
    const int64_t *integer, *last_integer;
    bool is_bad;
};

static int64_t read_int(struct reader *reader)
{
    const int64_t own = reader->integer != reader->last_integer ? *reader->integer : PTRDIFF_MAX;
    if (own < -@largest@ || own > @largest@) {
        reader->is_bad = true;
        return 0;
    }
    reader->integer++;
    return own;
}

static double *read_doubles(struct reader *reader, int64_t count)
{
    static const double nothing[1] = {0.0};
    const double *own = reader->number;
    if (reader->is_bad || count < 0 || count > reader->last_number - own) {
        reader->is_bad = true;
        return (double *)nothing;
    }
    reader->number = own + count;
    return (double *)own;
}

static int64_t *read_ints(struct reader *reader, int64_t count)
{
    static const int64_t nothing[1] = {0};
    const int64_t *own = reader->integer;
    if (reader->is_bad || count < 0 || count > reader->last_integer - own) {
        reader->is_bad = true;
        return (int64_t *)nothing;
    }
    reader->integer = own + count;
    return (int64_t *)own;
}

static int64_t read_size(struct reader *reader)
{
    const int64_t own = read_int(reader);
    reader->is_bad = reader->is_bad || own < 0;
    return own < 0 ? 0 : own;
}
