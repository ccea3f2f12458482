/* Parts of a user's own for the tables in @name@.c, made by iiwa_dnn @version@. */
#include "armstep.h"

@guard@
@own_code@

extern const struct armstep_own @name@_own[];

const struct armstep_own @name@_own[] = {
@own_rows@
    {0}, /* the end */
};
