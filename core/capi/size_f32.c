/* The least program around a search in steps, by which ./run measures what the library takes of flash. */
#include "brdfit.h"

static brdfit_block_f32 blocks[BRDFIT_BLOCKS(192)];
static brdfit_scan_f32 scan;
static brdfit_sample_f32 sample;
static brdfit_search_state_f32 search[BRDFIT_SEARCH(4, 4)];
static brdfit_found_f32 found;

int main(void) {
    uint32_t ended = 0;
    brdfit_error error = brdfit_scan_init_f32(&scan, blocks, BRDFIT_BLOCKS(192));
    if (!error) error = brdfit_scan_add_f32(&scan, &sample, 1);
    if (!error) error = brdfit_search_begin_f32(search, sizeof search, 4, 4, NULL);
    while (!error && !ended) error = brdfit_search_step_f32(search, &scan, 1, &ended);
    if (!error) error = brdfit_search_found_f32(search, NULL, 0, &found);
    return error != BRDFIT_ERROR_NONE;
}
