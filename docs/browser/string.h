/* What an exported controller needs of C's strings; `memory.c` has the functions. */
#include <stddef.h>

void *memcpy(void *to, const void *from, size_t size);
void *memset(void *to, int value, size_t size);
