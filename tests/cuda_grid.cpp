// The kernels of a shield on the CPU: the threads of a grid, one after another.
#include <cstddef>
#include <utility>

#define __global__
#define __device__
#define __noinline__ __attribute__((noinline))

struct index {
    unsigned x;
};
static thread_local index blockIdx, blockDim, threadIdx;

#include "shields.cu"

template <class... A, std::size_t... i>
static void launch(void (*kernel)(A...), unsigned blocks, void **given, std::index_sequence<i...>)
{
    for (blockIdx.x = 0; blockIdx.x < blocks; blockIdx.x++) {
        for (threadIdx.x = 0; threadIdx.x < blockDim.x; threadIdx.x++) {
            kernel(*static_cast<A *>(given[i])...);
        }
    }
}

template <class... A> static void launch(void (*kernel)(A...), unsigned blocks, unsigned threads, void **given)
{
    blockDim.x = threads;
    launch(kernel, blocks, given, std::index_sequence_for<A...>());
}

extern "C" void run_grid_step(unsigned blocks, unsigned threads, void **given)
{
    launch(grid_step, blocks, threads, given);
}

extern "C" void run_grid_load(unsigned blocks, unsigned threads, void **given)
{
    launch(grid_load, blocks, threads, given);
}

extern "C" void run_grid_rest(unsigned blocks, unsigned threads, void **given)
{
    launch(grid_rest, blocks, threads, given);
}
