/* Tables of the @kind@ of the robot @robot@, made by iiwa_dnn @version@, for armstep.h. */
#ifndef @NAME@_H
#define @NAME@_H

#include "armstep.h"

#ifdef __cplusplus
extern "C" {
#endif

enum {
    @NAME@_JOINTS = @joints@,
    @NAME@_FRAMES = @frames@,
    @NAME@_OBSTACLES = @obstacles@,
    @NAME@_LIMITS = @limits@,
    @NAME@_MEMORY = @memory@, /* doubles of an arm */
    @NAME@_SCRATCH = @scratch@ /* doubles that a call takes for itself */
};

extern const struct armstep_tables @name@;
@own_declaration@
#ifdef __cplusplus
}
#endif

#endif
