/* armstep: control steps of shields and controllers of any arm, made by iiwa_dnn @version@ from its own kernels.
 *
 * C99 and libm's elementary functions alone. Every function states the file that it is translated from. In this
 * order stand:
 *
 * - Types and constants of the functions
@map@
 * - Tables: how they are read
 * - Interface: what the header declares
 *
 * A struct whose first member is `numbers` is a record, an array of numbers by their names: `at` has the first
 * ones, the other members are arrays within it. `X_of` views an array as a record X.
 */
#include "armstep.h"
