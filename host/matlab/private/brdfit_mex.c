/*
 * The MEX behind brdfit_fit.m, brdfit_brdf.m and brdfit_program.m, which check the form of what they give to it:
 *
 *   [x, cost, stop, passes, minima, fitted, unit, known] = brdfit_mex ("fit", samples, settings, lb, ub)
 *   f = brdfit_mex ("brdf", directions, x, model)
 *
 *   [wrong, text] = brdfit_mex ("program", words, table)
 *
 * samples is 5 x n: theta_i, theta_s and delta_phi in radians, brdf in sr^-1, 1. settings is [seed, terms, candidates,
 * max_passes, cost_tolerance, step_tolerance, model, sigma], where NaN stands for the usual value and sigma is 1 if the
 * last row of samples is sigma / brdf, else 0. passes is [of the best fit, without derivatives, with derivatives],
 * minima 8 x k: parameters, cost, hits; fitted 2 x n: brdf and weight as they were fitted, unit the standard deviation
 * of ln brdf that a weight of 1 stands for, 1 without sigma; known 1 x 49: standard errors, correlations, the coverage factor of 95 %, the
 * effective degrees of freedom, the angle over which residuals are correlated in degrees or NaN, the least and the
 * largest factor of that on errors; scale, condition. directions is 3 x n.
 * model is BRDFIT_MODEL_BECKMANN or BRDFIT_MODEL_GGX. words have line breaks between; text is what the program prints, or
 * says if something is wrong.
 */
#include <stdint.h>
#include <string.h>

#include "brdfit.h"
#include "mex.h"

#define MINIMA 32
/* Numbers that brdfit_matlab_known writes. */
#define KNOWN 47

/* host/matlab/src/lib.rs */
typedef struct {
    uint64_t seed;
    uint32_t candidates, terms, ggx;
    double sigma_ln;
} asked_of_search;
double brdfit_matlab_weighted(double *samples, size_t count, const asked_of_search *asked, const double *lower,
                              const double *upper);
int32_t brdfit_matlab_known(const double *samples, size_t count, const asked_of_search *asked, const double *lower,
                            const double *upper, const double *x, double *to);

int32_t brdfit_matlab_program(const char *words, const char *table, char **answer);
void brdfit_matlab_forget(char *answer);

/* What the program calls brdfit:... */
static const char *identifier(brdfit_error error) {
    switch (error) {
    case BRDFIT_ERROR_NOT_FINITE:
        return "brdfit:notFinite";
    case BRDFIT_ERROR_BEYOND_HORIZON:
        return "brdfit:beyondHorizon";
    case BRDFIT_ERROR_NOT_POSITIVE:
        return "brdfit:notPositive";
    case BRDFIT_ERROR_PARAMS:
        return "brdfit:badParameters";
    case BRDFIT_ERROR_BOUNDS:
        return "brdfit:badBounds";
    case BRDFIT_ERROR_TERMS:
        return "brdfit:badTerms";
    case BRDFIT_ERROR_OPTIONS:
        return "brdfit:badOption";
    case BRDFIT_ERROR_TOO_FEW:
        return "brdfit:tooFewSamples";
    case BRDFIT_ERROR_NO_FIT:
        return "brdfit:noFit";
    default:
        return "brdfit:internal";
    }
}

static void check(brdfit_error error) {
    if (error)
        mexErrMsgIdAndTxt(identifier(error), "brdfit: %s", brdfit_error_text(error));
}

static void check_sample(brdfit_error error, size_t index) {
    if (error)
        mexErrMsgIdAndTxt(identifier(error), "brdfit: sample %lu: %s", (unsigned long)index + 1,
                          brdfit_error_text(error));
}

/* A matrix of doubles with so many rows, or with any number of columns if columns is 0. */
static const double *matrix(const mxArray *array, size_t rows, size_t columns) {
    if (!mxIsDouble(array) || mxIsComplex(array) || mxGetM(array) != rows || (columns && mxGetN(array) != columns))
        mexErrMsgIdAndTxt("brdfit:internal", "brdfit_mex: an argument has the wrong type or size");
    return mxGetPr(array);
}

static brdfit_params_f64 params(const double *x) {
    brdfit_params_f64 params = {x[0], x[1], x[2], x[3], x[4], x[5]};
    return params;
}

static void put_params(double *x, const brdfit_params_f64 *params) {
    const double values[6] = {params->rho_d, params->rho_s, params->rho_v, params->m, params->n, params->kappa};
    memcpy(x, values, sizeof values);
}

static mxArray *scalar(double value) { return mxCreateDoubleScalar(value); }

static void fill(brdfit_scan_f64 *scan, brdfit_block_f64 *memory, size_t blocks, const double *samples, size_t count) {
    check(brdfit_scan_init_f64(scan, memory, blocks));
    for (size_t i = 0; i < count; i++) {
        const double *row = samples + 5 * i;
        const brdfit_sample_f64 sample = {row[0], row[1], row[2], row[3], row[4]};
        check_sample(brdfit_scan_add_f64(scan, &sample, 1), i);
    }
}

static void fit(int outputs, mxArray *output[], const mxArray *input[]) {
    const double *given = matrix(input[1], 5, 0), *settings = matrix(input[2], 1, 8);
    const size_t count = mxGetN(input[1]), blocks = BRDFIT_BLOCKS(count);
    brdfit_scan_f64 scan;
    brdfit_options_f64 options;
    brdfit_found_f64 found;
    brdfit_minimum_f64 minima[MINIMA];
    /* MATLAB frees it, also after an error; its alignment is less than that of a block. */
    char *memory = mxMalloc(blocks * sizeof(brdfit_block_f64) + BRDFIT_BLOCK_ALIGNMENT);
    memory += (BRDFIT_BLOCK_ALIGNMENT - (uintptr_t)memory % BRDFIT_BLOCK_ALIGNMENT) % BRDFIT_BLOCK_ALIGNMENT;

    double *samples = mxMalloc((5 * count + 1) * sizeof(double));
    memcpy(samples, given, 5 * count * sizeof(double));
    fill(&scan, (brdfit_block_f64 *)memory, blocks, samples, count);
    check(brdfit_options_init_f64(&options));
    options.seed = (uint64_t)settings[0];
    options.terms = (uint32_t)settings[1];
    if (!mxIsNaN(settings[2]))
        options.candidates = (uint32_t)settings[2];
    if (!mxIsNaN(settings[3]))
        options.max_passes = (uint32_t)settings[3];
    if (!mxIsNaN(settings[4]))
        options.cost_tolerance = settings[4];
    if (!mxIsNaN(settings[5]))
        options.step_tolerance = settings[5];
    options.model = (uint32_t)settings[6];
    options.lower = params(matrix(input[3], 1, 6));
    options.upper = params(matrix(input[4], 1, 6));
    asked_of_search asked = {options.seed, mxIsNaN(settings[2]) ? 0 : options.candidates, options.terms,
                             options.model != BRDFIT_MODEL_BECKMANN, 0};
    /* Threads of the program's library stay, so the code must. */
    if (!mexIsLocked())
        mexLock();
    if (settings[7] != 0) {
        asked.sigma_ln = brdfit_matlab_weighted(samples, count, &asked, mxGetPr(input[3]), mxGetPr(input[4]));
        fill(&scan, (brdfit_block_f64 *)memory, blocks, samples, count);
    }
    const double unit = settings[7] != 0 ? asked.sigma_ln : 1;
    check(brdfit_search_f64(&scan, &options, minima, MINIMA, &found));

    output[0] = mxCreateDoubleMatrix(1, 6, mxREAL);
    put_params(mxGetPr(output[0]), &found.best.params);
    if (outputs > 1)
        output[1] = scalar(found.best.cost);
    if (outputs > 2)
        output[2] = scalar(found.best.stop);
    if (outputs > 3) {
        output[3] = mxCreateDoubleMatrix(1, 3, mxREAL);
        mxGetPr(output[3])[0] = found.best.passes;
        mxGetPr(output[3])[1] = found.cost_passes;
        mxGetPr(output[3])[2] = found.linearize_passes;
    }
    if (outputs > 4) {
        output[4] = mxCreateDoubleMatrix(8, found.minima, mxREAL);
        for (size_t i = 0; i < found.minima; i++) {
            double *column = mxGetPr(output[4]) + 8 * i;
            put_params(column, &minima[i].params);
            column[6] = minima[i].cost;
            column[7] = minima[i].hits;
        }
    }
    if (outputs > 5) {
        output[5] = mxCreateDoubleMatrix(2, count, mxREAL);
        for (size_t i = 0; i < count; i++)
            memcpy(mxGetPr(output[5]) + 2 * i, samples + 5 * i + 3, 2 * sizeof(double));
    }
    if (outputs > 6)
        output[6] = scalar(unit);
    if (outputs > 7) {
        brdfit_uncertainty_f64 known;
        check(brdfit_uncertainty_at_f64(&scan, &options, &found.best.params, &known));
        output[7] = mxCreateDoubleMatrix(1, KNOWN + 2, mxREAL);
        double *values = mxGetPr(output[7]);
        if (brdfit_matlab_known(samples, count, &asked, mxGetPr(input[3]), mxGetPr(input[4]), mxGetPr(output[0]),
                                values))
            check(BRDFIT_ERROR_NO_FIT);
        values[KNOWN] = known.scale / unit;
        values[KNOWN + 1] = known.condition;
    }
}

static void brdf(mxArray *output[], const mxArray *input[]) {
    const double *directions = matrix(input[1], 3, 0);
    const brdfit_params_f64 x = params(matrix(input[2], 1, 6));
    const uint32_t model = (uint32_t)*matrix(input[3], 1, 1);
    const size_t count = mxGetN(input[1]);
    output[0] = mxCreateDoubleMatrix(1, count, mxREAL);
    for (size_t i = 0; i < count; i++) {
        const double *direction = directions + 3 * i;
        const brdfit_error error =
            brdfit_model_brdf_f64(model, direction[0], direction[1], direction[2], &x, mxGetPr(output[0]) + i);
        if (error == BRDFIT_ERROR_PARAMS)
            check(error);
        check_sample(error, i);
    }
}

static void program(mxArray *output[], const mxArray *input[]) {
    char *words = mxArrayToString(input[1]), *table = mxArrayToString(input[2]), *answer = NULL;
    if (!words || !table)
        mexErrMsgIdAndTxt("brdfit:internal", "brdfit_mex: words and table must be text");
    if (!mexIsLocked())
        mexLock();
    output[0] = scalar(brdfit_matlab_program(words, table, &answer));
    output[1] = mxCreateString(answer);
    brdfit_matlab_forget(answer);
    mxFree(words);
    mxFree(table);
}

void mexFunction(int outputs, mxArray *output[], int inputs, const mxArray *input[]) {
    char name[8] = "";
    if (inputs > 0 && mxIsChar(input[0]))
        mxGetString(input[0], name, sizeof name);
    if (!strcmp(name, "fit") && inputs == 5)
        fit(outputs, output, input);
    else if (!strcmp(name, "brdf") && inputs == 4)
        brdf(output, input);
    else if (!strcmp(name, "program") && inputs == 3 && outputs == 2)
        program(output, input);
    else
        mexErrMsgIdAndTxt("brdfit:internal", "brdfit_mex is for brdfit_fit, brdfit_brdf and brdfit_program");
}
