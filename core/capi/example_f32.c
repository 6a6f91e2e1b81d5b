/*
 * Simulates a scan with noise, searches its parameters, and makes one fit in pieces as firmware would between two
 * movements of its goniometer. Each machine prints the lines of example_f32.out: every number by its bits, and after ~ for the reader.
 */
#include <stdio.h>
#include <string.h>

#include "brdfit.h"

#define SAMPLES 57
#define MINIMA 4
#define FITS 4

/* The compiler gives this memory; the library has none. */
static brdfit_block_f32 blocks[BRDFIT_BLOCKS(SAMPLES)];
static brdfit_fit_f32 fit;
static brdfit_search_state_f32 state[BRDFIT_SEARCH(MINIMA, FITS)];
static uint8_t flash[sizeof state];

static void print_number(const char *name, float value) {
    uint32_t words[sizeof value / 4];
    memcpy(words, &value, sizeof value);
    printf("  %s ", name);
    for (size_t i = sizeof value / 4; i-- > 0;)
        printf("%08lx", (unsigned long)words[i]);
    printf(" ~%.6f\n", (double)value);
}

static void print_params(const brdfit_params_f32 *params) {
    print_number("rho_d", params->rho_d);
    print_number("rho_s", params->rho_s);
    print_number("rho_v", params->rho_v);
    print_number("m", params->m);
    print_number("n", params->n);
    print_number("kappa", params->kappa);
}

static void print_result(const brdfit_result_f32 *result) {
    printf("  passes %u, %s\n", (unsigned)result->passes, brdfit_stop_text(result->stop));
    print_number("cost", result->cost);
    print_params(&result->params);
}

/* A glossy paint seen at 57 angles in the plane of incidence, with noise of +-10 %. */
static brdfit_error simulate(brdfit_scan_f32 *scan) {
    const brdfit_params_f32 truth = {(float)0.05, 10, (float)0.01, (float)0.125, (float)1.5, 0};
    uint32_t random = 1;
    brdfit_error error = brdfit_scan_init_f32(scan, blocks, BRDFIT_BLOCKS(SAMPLES));
    for (int i = 0; i < SAMPLES && !error; i++) {
        brdfit_sample_f32 sample;
        sample.theta_i = (float)0.5;
        sample.theta_s = (float)(i - SAMPLES / 2) / 20;
        sample.delta_phi = (float)BRDFIT_PI;
        sample.weight = 1;
        error = brdfit_brdf_f32(sample.theta_i, sample.theta_s, sample.delta_phi, &truth, &sample.brdf);
        if (error)
            break;
        random = random * 1664525u + 1013904223u;
        sample.brdf *= 1 + ((float)(random >> 16) / 32768 - 1) / 10;
        error = brdfit_scan_add_f32(scan, &sample, 1);
    }
    return error;
}

static brdfit_error search(const brdfit_scan_f32 *scan, const brdfit_options_f32 *options) {
    brdfit_minimum_f32 minima[MINIMA];
    brdfit_found_f32 found;
    brdfit_error error = brdfit_search_f32(scan, options, minima, MINIMA, &found);
    if (error)
        return error;
    printf("search, model %u, terms %u: %u distinct minima, passes %u and %u\n", (unsigned)options->model, (unsigned)options->terms,
           (unsigned)found.minima, (unsigned)found.cost_passes, (unsigned)found.linearize_passes);
    print_result(&found.best);
    for (size_t i = 0; i < found.minima; i++) {
        printf("  minimum with %u hits\n", (unsigned)minima[i].hits);
        print_number("cost", minima[i].cost);
    }
    return BRDFIT_ERROR_NONE;
}

/* The best of eight candidates, then ten passes at a time. */
static brdfit_error in_pieces(const brdfit_scan_f32 *scan, const brdfit_options_f32 *options) {
    brdfit_result_f32 result, best = {{0, 0, 0, 1, 1, 0}, -1, 0, BRDFIT_STOP_NONE};
    brdfit_error error = BRDFIT_ERROR_NONE;
    for (uint64_t i = 0; i < 8 && !error; i++) {
        brdfit_params_f32 start;
        error = brdfit_candidate_f32(scan, options, i, &start);
        if (!error)
            error = brdfit_fit_begin_f32(&fit, scan, &start, options);
        if (!error)
            error = brdfit_fit_result_f32(&fit, &result);
        if (!error && (best.cost < 0 || result.cost < best.cost)) {
            best = result;
            best.params = start;
        }
    }
    if (!error)
        error = brdfit_fit_begin_f32(&fit, scan, &best.params, options);
    printf("fit in pieces\n");
    do {
        if (!error)
            error = brdfit_fit_run_f32(&fit, scan, 10);
        if (!error)
            error = brdfit_fit_result_f32(&fit, &result);
        if (!error) {
            printf("  after %u passes\n", (unsigned)result.passes);
            print_number("cost", result.cost);
        }
    } while (!error && result.stop == BRDFIT_STOP_NONE);
    if (!error)
        print_result(&result);
    return error;
}

/* One pass at a time, as between two movements of a goniometer; after a while a reset interrupts it. */
static brdfit_error in_steps(const brdfit_scan_f32 *scan, const brdfit_options_f32 *options) {
    brdfit_found_f32 found;
    brdfit_uncertainty_f32 known;
    size_t length = 0;
    uint32_t ended = 0, steps = 0;
    brdfit_error error = brdfit_search_begin_f32(state, sizeof state, MINIMA, FITS, options);
    while (!error && !ended) {
        error = brdfit_search_step_f32(state, scan, 1, &ended);
        if (++steps == 100 && !error) {
            error = brdfit_search_save_f32(state, flash, sizeof flash, &length);
            memset(state, 0, sizeof state);
            if (!error)
                error = brdfit_search_restore_f32(state, sizeof state, MINIMA, FITS, options, flash, length);
        }
    }
    if (!error)
        error = brdfit_search_found_f32(state, NULL, 0, &found);
    if (!error)
        error = brdfit_uncertainty_at_f32(scan, options, &found.best.params, &known);
    if (error)
        return error;
    printf("search in %u steps, over a reset\n", (unsigned)steps);
    print_result(&found.best);
    printf("  standard errors\n");
    print_params(&known.standard_errors);
    return BRDFIT_ERROR_NONE;
}

static void expect_error(const char *what, brdfit_error error) {
    printf("  %s: %s\n", what, brdfit_error_text(error));
}

/* Mistakes are errors, not crashes. */
static void mistakes(brdfit_scan_f32 *scan) {
    brdfit_options_f32 options;
    brdfit_params_f32 params = {0, 0, 0, 1, 1, 0};
    brdfit_found_f32 found;
    brdfit_scan_f32 none = {NULL, 0, 0};
    brdfit_sample_f32 sample = {0, 0, 0, 1, 1};
    float value = 0;
    printf("mistakes\n");
    expect_error("null", brdfit_search_f32(NULL, NULL, NULL, 0, &found));
    expect_error("zero length", brdfit_scan_add_f32(scan, &sample, 0));
    expect_error("no scan", brdfit_search_f32(&none, NULL, NULL, 0, &found));
    sample.brdf = value / value;
    expect_error("NaN", brdfit_scan_add_f32(scan, &sample, 1));
    sample.brdf = 0;
    expect_error("no light", brdfit_scan_add_f32(scan, &sample, 1));
    params.n = 0;
    expect_error("n = 0", brdfit_brdf_f32(0, 0, 0, &params, &value));
    brdfit_options_init_f32(&options);
    options.terms = BRDFIT_VOLUME;
    expect_error("volume alone", brdfit_search_f32(scan, &options, NULL, 0, &found));
    expect_error("a minimum too many", brdfit_search_begin_f32(state, sizeof state, MINIMA + 1, FITS, NULL));
}

int main(void) {
    brdfit_options_f32 options;
    brdfit_scan_f32 scan;
    brdfit_error error = simulate(&scan);
    printf("brdfit %s\n", brdfit_version());
    if (!error)
        error = brdfit_options_init_f32(&options);
    if (!error)
        error = search(&scan, &options);
    if (!error)
        error = in_pieces(&scan, &options);
    if (!error)
        error = in_steps(&scan, &options);
    options.terms = BRDFIT_DIFFUSE | BRDFIT_SURFACE;
    if (!error)
        error = search(&scan, &options);
    options.terms = BRDFIT_ALL;
    options.model = BRDFIT_MODEL_GGX;
    if (!error)
        error = search(&scan, &options);
    mistakes(&scan);
    if (error)
        printf("%s\n", brdfit_error_text(error));
    return error ? 1 : 0;
}
