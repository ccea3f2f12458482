/* Parts of a user's own for the tables in @name@.c, made by iiwa_dnn @version@. */
#include "@name@.h"

@guard@
@own_code@

const struct armstep_own @name@_own[] = {
@own_rows@
};
