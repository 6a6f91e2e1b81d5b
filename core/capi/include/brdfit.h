/*
 * brdfit: the parameters of microfacet BRDF models from scatterometer scans, the same bits everywhere.
 * MIT or Apache-2.0, at your choice. Made by cbindgen from the Rust source: do not edit.
 *
 * Samples go into blocks of the caller (brdfit_scan_init, brdfit_scan_add), then brdfit_search finds
 * the global optimum (brdfit_search_begin, _step and _found step by step), or brdfit_fit_begin, _run and _result make a fit from one start, step by step.
 * Names end in _f32 for float and in _f64 for double.
 *
 * Nothing allocates, does I/O, keeps a state of its own or blocks: any function may be called from any
 * thread or interrupt on data that no other one is using. The stack that they need is in README.md.
 *
 * Pointers: a null or misaligned one is an error, unless the text says what null means. Any other one
 * must point to as many objects as the text says; those that a function writes must not overlap others
 * that it was given. Memory that a function sets need not be initialised before. After an error
 * nothing was written, unless the text says so.
 */


#ifndef BRDFIT_H
#define BRDFIT_H

#include <stddef.h>
#include <stdint.h>

/* Compilers that know neither GNU's attributes nor Microsoft's: give this before the header. */
#ifndef BRDFIT_ALIGNED
#ifdef _MSC_VER
#define BRDFIT_ALIGNED(n) __declspec(align(n))
#else
#define BRDFIT_ALIGNED(n) __attribute__((aligned(n)))
#endif
#endif

/* Number of blocks that hold so many samples. */
#define BRDFIT_BLOCKS(samples) (((samples) + BRDFIT_BLOCK_SAMPLES - 1) / BRDFIT_BLOCK_SAMPLES)

/* Number of brdfit_search_state for a search in steps that remembers so many minima and has so many fits under way. */
#define BRDFIT_SEARCH(minima, fits) (BRDFIT_SEARCH_BASE + BRDFIT_SEARCH_MINIMUM * (minima) + BRDFIT_SEARCH_FIT * (fits))


/**
 * Lambertian term rho_d / pi.
 */
#define BRDFIT_DIFFUSE 1

/**
 * Surface lobe, around the specular direction.
 */
#define BRDFIT_SURFACE 2

/**
 * Volume lobe, around the direction back to the source.
 */
#define BRDFIT_VOLUME 4

/**
 * kappa is a parameter; without it kappa = 0.
 */
#define BRDFIT_ABSORBING 8

/**
 * All terms: six parameters.
 */
#define BRDFIT_ALL 15

/**
 * The model of Eq. 14: Beckmann's distribution of facets.
 */
#define BRDFIT_MODEL_BECKMANN 0

/**
 * The same with the distribution of Trowbridge and Reitz, called GGX, whose tails are wider; of it the terms are BRDFIT_ALL.
 */
#define BRDFIT_MODEL_GGX 1

/**
 * Samples that one block holds.
 */
#define BRDFIT_BLOCK_SAMPLES 16

/**
 * Size of a block, in numbers of its type.
 */
#define BRDFIT_BLOCK_NUMBERS 128

/**
 * Size of a block of float, bytes.
 */
#define BRDFIT_BLOCK_SIZE_F32 512

/**
 * Size of a block of double, bytes.
 */
#define BRDFIT_BLOCK_SIZE_F64 1024

/**
 * Alignment of a block, bytes.
 */
#define BRDFIT_BLOCK_ALIGNMENT 64

/**
 * Size of a fit, in numbers of its type.
 */
#define BRDFIT_FIT_NUMBERS 96

/**
 * Size of a fit in float, bytes.
 */
#define BRDFIT_FIT_SIZE_F32 384

/**
 * Size of a fit in double, bytes.
 */
#define BRDFIT_FIT_SIZE_F64 768

/**
 * Of a search in steps, what does not depend on its minima and fits, in units of brdfit_search_state.
 */
#define BRDFIT_SEARCH_BASE 196

/**
 * What a minimum takes of it.
 */
#define BRDFIT_SEARCH_MINIMUM 5

/**
 * What a fit takes of it.
 */
#define BRDFIT_SEARCH_FIT 31

/**
 * pi: the delta_phi of samples in the plane of incidence; (float)BRDFIT_PI in single precision.
 */
#define BRDFIT_PI 3.141592653589793

/**
 * What every function returns; brdfit_error_text() says it in words.
 */
enum brdfit_error
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /**
   * No error.
   */
  BRDFIT_ERROR_NONE = 0,
  /**
   * A pointer is null.
   */
  BRDFIT_ERROR_NULL = -1,
  /**
   * A pointer is not aligned as its type asks; blocks need BRDFIT_BLOCK_ALIGNMENT bytes.
   */
  BRDFIT_ERROR_MISALIGNED = -2,
  /**
   * A length is zero, or larger than memory can be.
   */
  BRDFIT_ERROR_LENGTH = -3,
  /**
   * There is no room for a further sample.
   */
  BRDFIT_ERROR_FULL = -4,
  /**
   * A number is NaN or infinite.
   */
  BRDFIT_ERROR_NOT_FINITE = -5,
  /**
   * An angle is at or beyond the horizon, or theta_i is negative.
   */
  BRDFIT_ERROR_BEYOND_HORIZON = -6,
  /**
   * A BRDF or a weight is zero or negative.
   */
  BRDFIT_ERROR_NOT_POSITIVE = -7,
  /**
   * A parameter has a value that it cannot have: see brdfit_params.
   */
  BRDFIT_ERROR_PARAMS = -8,
  /**
   * Lower bounds are above the upper ones, or a bound has a value that its parameter cannot have.
   */
  BRDFIT_ERROR_BOUNDS = -9,
  /**
   * There is no such model, or none of just these terms.
   */
  BRDFIT_ERROR_TERMS = -10,
  /**
   * A tolerance, the damping or a number of passes or candidates is out of range.
   */
  BRDFIT_ERROR_OPTIONS = -11,
  /**
   * There are fewer samples than parameters.
   */
  BRDFIT_ERROR_TOO_FEW = -12,
  /**
   * The scan, the fit or the search was never begun, or has been overwritten.
   */
  BRDFIT_ERROR_NOT_BEGUN = -13,
  /**
   * No start gives a finite model, or no fit has begun yet.
   */
  BRDFIT_ERROR_NO_FIT = -14,
  /**
   * Bytes are not a saved search of this version, of these terms, minima and fits and this type of number, or were damaged.
   */
  BRDFIT_ERROR_SAVED = -15,
  /**
   * The memory of a search is smaller than what its minima and fits take: see BRDFIT_SEARCH.
   */
  BRDFIT_ERROR_SMALL = -16,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum brdfit_error brdfit_error;
#else
typedef int32_t brdfit_error;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * How a fit ended; brdfit_stop_text() says it in words.
 */
enum brdfit_stop
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /**
   * It has not ended.
   */
  BRDFIT_STOP_NONE = 0,
  /**
   * Converged: no further reduction worth the cost tolerance is to be expected.
   */
  BRDFIT_STOP_COST = 1,
  /**
   * Converged as far as rounding allows.
   */
  BRDFIT_STOP_STEP = 2,
  /**
   * The largest number of passes was made.
   */
  BRDFIT_STOP_PASSES = 3,
  /**
   * The model is not finite at the start: nothing was done.
   */
  BRDFIT_STOP_NOT_FINITE = 4,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum brdfit_stop brdfit_stop;
#else
typedef int32_t brdfit_stop;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * The six parameters of Eq. 14 and of GGX, dimensionless; those of absent terms are 0, but m and n are 1.
 */
typedef struct {
  /**
   * Diffuse reflectance, 0 to 1e6.
   */
  float rho_d;
  /**
   * Weight of the surface lobe, 0 to 1e6.
   */
  float rho_s;
  /**
   * Weight of the volume lobe, 0 to 1e6.
   */
  float rho_v;
  /**
   * Slope of the facets, 1e-6 to 1e6.
   */
  float m;
  /**
   * Real part of the index of refraction n - i kappa, 1 to 1e6.
   */
  float n;
  /**
   * Its imaginary part, 0 to 1e6.
   */
  float kappa;
} brdfit_params_f32;

/**
 * What to fit and how; brdfit_options_init_f32() and _f64() set all of it.
 */
typedef struct {
  /**
   * Seed of the candidates of a search; 0.
   */
  uint64_t seed;
  /**
   * A sum of BRDFIT_DIFFUSE and others; BRDFIT_ALL.
   */
  uint32_t terms;
  /**
   * BRDFIT_MODEL_BECKMANN or BRDFIT_MODEL_GGX; BRDFIT_MODEL_BECKMANN.
   */
  uint32_t model;
  /**
   * Largest number of candidates of a search, at least 1; 435. Of more than that all are made.
   */
  uint32_t candidates;
  /**
   * Largest number of passes of a fit, at least 1; 500.
   */
  uint32_t max_passes;
  /**
   * Least parameters; Table 1 of the paper. Equal to the upper ones they hold a parameter fixed.
   */
  brdfit_params_f32 lower;
  /**
   * Largest parameters; Table 1 of the paper.
   */
  brdfit_params_f32 upper;
  /**
   * A fit ends when its linear model promises a relative reduction of the cost of at most this; the distance from 1 to the next number.
   */
  float cost_tolerance;
  /**
   * A fit ends when no step longer than this part of each parameter lowers the cost; the distance from 1 to the next number.
   */
  float step_tolerance;
  /**
   * First damping of a fit, in units of the largest diagonal of J'J; 1e-3.
   */
  float damping;
} brdfit_options_f32;

/**
 * Memory of BRDFIT_BLOCK_SAMPLES samples.
 */
typedef struct BRDFIT_ALIGNED(64) {
  /**
   * Not to be touched.
   */
  float opaque[BRDFIT_BLOCK_NUMBERS];
} brdfit_block_f32;

/**
 * Samples in blocks of the caller. The fields are to be read only: brdfit_scan_init_f32() and others write them.
 */
typedef struct {
  /**
   * The caller's blocks.
   */
  brdfit_block_f32 *blocks;
  /**
   * Their number.
   */
  size_t capacity;
  /**
   * Samples added so far.
   */
  size_t samples;
} brdfit_scan_f32;

/**
 * One measured value of the BRDF.
 */
typedef struct {
  /**
   * Angle of incidence, radians, 0 <= theta_i < pi/2.
   */
  float theta_i;
  /**
   * Scattering angle, radians, -pi/2 < theta_s < pi/2; in plane positive forward, towards the specular peak.
   */
  float theta_s;
  /**
   * Azimuth of scattering less azimuth of incidence, radians; BRDFIT_PI is forward.
   */
  float delta_phi;
  /**
   * Measured BRDF, sr^-1, above 0.
   */
  float brdf;
  /**
   * Factor of the residual of ln BRDF, dimensionless, above 0: 1, or 1 / sigma with sigma the relative standard uncertainty of brdf.
   */
  float weight;
} brdfit_sample_f32;

/**
 * A fit under way; it holds no pointers, and may be copied.
 */
typedef struct BRDFIT_ALIGNED(8) {
  /**
   * Not to be touched.
   */
  float opaque[BRDFIT_FIT_NUMBERS];
} brdfit_fit_f32;

/**
 * Where a fit is.
 */
typedef struct {
  /**
   * The best parameters so far.
   */
  brdfit_params_f32 params;
  /**
   * Sum of squared weighted residuals of ln BRDF there, dimensionless; MSE^2 of the paper is cost / samples^2.
   */
  float cost;
  /**
   * Evaluations of the model with its derivatives, each over all samples, so far.
   */
  uint32_t passes;
  /**
   * How it ended, if it has.
   */
  brdfit_stop stop;
} brdfit_result_f32;

/**
 * One of the distinct minima that a search found.
 */
typedef struct {
  /**
   * Its parameters.
   */
  brdfit_params_f32 params;
  /**
   * As in brdfit_result.
   */
  float cost;
  /**
   * How many fits ended here.
   */
  uint32_t hits;
} brdfit_minimum_f32;

/**
 * What a search found, and what it took.
 */
typedef struct {
  /**
   * The best fit.
   */
  brdfit_result_f32 best;
  /**
   * Number of distinct minima that were written.
   */
  size_t minima;
  /**
   * Evaluations of the model without derivatives.
   */
  uint32_t cost_passes;
  /**
   * Evaluations with derivatives.
   */
  uint32_t linearize_passes;
} brdfit_found_f32;

/**
 * What the model needs to know of a pair of directions, first for the surface lobe, then for the volume lobe; dimensionless.
 */
typedef struct {
  /**
   * tan^2 theta_h and tan^2 theta_he (Eq. 13), 0 or more.
   */
  float tan2_theta_h[2];
  /**
   * cos theta_d and cos theta_de (Eq. 12), above 0, at most 1.
   */
  float cos_theta_d[2];
  /**
   * What else of f does not depend on the parameters, 0 or more.
   */
  float factor[2];
} brdfit_geometry_f32;

/**
 * A unit of the memory of a search under way, which takes BRDFIT_SEARCH(minima, fits) of them, one after the other; all of them together may be copied.
 */
typedef struct BRDFIT_ALIGNED(8) {
  /**
   * Not to be touched.
   */
  float opaque[2];
} brdfit_search_state_f32;

/**
 * What a fit knows of its parameters, for residuals of equal and independent errors. Where residuals wander along the angle, as those of most measured scans do, true errors are several times larger; the program brdfit estimates that, this does not.
 */
typedef struct {
  /**
   * Standard errors; 0 of parameters that are absent, held or on a bound (of kappa at 0 too), very large where nothing is known.
   */
  brdfit_params_f32 standard_errors;
  /**
   * Correlations, -1 to 1, row by row in the order of brdfit_params; 0 where one is absent or held.
   */
  float correlations[36];
  /**
   * Standard deviation of a residual; infinite without degrees of freedom.
   */
  float scale;
  /**
   * Ratio of the largest to the least eigenvalue of the scaled J'J, 1 or more.
   */
  float condition;
} brdfit_uncertainty_f32;

/**
 * The six parameters of Eq. 14 and of GGX, dimensionless; those of absent terms are 0, but m and n are 1.
 */
typedef struct {
  /**
   * Diffuse reflectance, 0 to 1e6.
   */
  double rho_d;
  /**
   * Weight of the surface lobe, 0 to 1e6.
   */
  double rho_s;
  /**
   * Weight of the volume lobe, 0 to 1e6.
   */
  double rho_v;
  /**
   * Slope of the facets, 1e-6 to 1e6.
   */
  double m;
  /**
   * Real part of the index of refraction n - i kappa, 1 to 1e6.
   */
  double n;
  /**
   * Its imaginary part, 0 to 1e6.
   */
  double kappa;
} brdfit_params_f64;

/**
 * What to fit and how; brdfit_options_init_f32() and _f64() set all of it.
 */
typedef struct {
  /**
   * Seed of the candidates of a search; 0.
   */
  uint64_t seed;
  /**
   * A sum of BRDFIT_DIFFUSE and others; BRDFIT_ALL.
   */
  uint32_t terms;
  /**
   * BRDFIT_MODEL_BECKMANN or BRDFIT_MODEL_GGX; BRDFIT_MODEL_BECKMANN.
   */
  uint32_t model;
  /**
   * Largest number of candidates of a search, at least 1; 435. Of more than that all are made.
   */
  uint32_t candidates;
  /**
   * Largest number of passes of a fit, at least 1; 500.
   */
  uint32_t max_passes;
  /**
   * Least parameters; Table 1 of the paper. Equal to the upper ones they hold a parameter fixed.
   */
  brdfit_params_f64 lower;
  /**
   * Largest parameters; Table 1 of the paper.
   */
  brdfit_params_f64 upper;
  /**
   * A fit ends when its linear model promises a relative reduction of the cost of at most this; the distance from 1 to the next number.
   */
  double cost_tolerance;
  /**
   * A fit ends when no step longer than this part of each parameter lowers the cost; the distance from 1 to the next number.
   */
  double step_tolerance;
  /**
   * First damping of a fit, in units of the largest diagonal of J'J; 1e-3.
   */
  double damping;
} brdfit_options_f64;

/**
 * Memory of BRDFIT_BLOCK_SAMPLES samples.
 */
typedef struct BRDFIT_ALIGNED(64) {
  /**
   * Not to be touched.
   */
  double opaque[BRDFIT_BLOCK_NUMBERS];
} brdfit_block_f64;

/**
 * Samples in blocks of the caller. The fields are to be read only: brdfit_scan_init_f32() and others write them.
 */
typedef struct {
  /**
   * The caller's blocks.
   */
  brdfit_block_f64 *blocks;
  /**
   * Their number.
   */
  size_t capacity;
  /**
   * Samples added so far.
   */
  size_t samples;
} brdfit_scan_f64;

/**
 * One measured value of the BRDF.
 */
typedef struct {
  /**
   * Angle of incidence, radians, 0 <= theta_i < pi/2.
   */
  double theta_i;
  /**
   * Scattering angle, radians, -pi/2 < theta_s < pi/2; in plane positive forward, towards the specular peak.
   */
  double theta_s;
  /**
   * Azimuth of scattering less azimuth of incidence, radians; BRDFIT_PI is forward.
   */
  double delta_phi;
  /**
   * Measured BRDF, sr^-1, above 0.
   */
  double brdf;
  /**
   * Factor of the residual of ln BRDF, dimensionless, above 0: 1, or 1 / sigma with sigma the relative standard uncertainty of brdf.
   */
  double weight;
} brdfit_sample_f64;

/**
 * A fit under way; it holds no pointers, and may be copied.
 */
typedef struct BRDFIT_ALIGNED(8) {
  /**
   * Not to be touched.
   */
  double opaque[BRDFIT_FIT_NUMBERS];
} brdfit_fit_f64;

/**
 * Where a fit is.
 */
typedef struct {
  /**
   * The best parameters so far.
   */
  brdfit_params_f64 params;
  /**
   * Sum of squared weighted residuals of ln BRDF there, dimensionless; MSE^2 of the paper is cost / samples^2.
   */
  double cost;
  /**
   * Evaluations of the model with its derivatives, each over all samples, so far.
   */
  uint32_t passes;
  /**
   * How it ended, if it has.
   */
  brdfit_stop stop;
} brdfit_result_f64;

/**
 * One of the distinct minima that a search found.
 */
typedef struct {
  /**
   * Its parameters.
   */
  brdfit_params_f64 params;
  /**
   * As in brdfit_result.
   */
  double cost;
  /**
   * How many fits ended here.
   */
  uint32_t hits;
} brdfit_minimum_f64;

/**
 * What a search found, and what it took.
 */
typedef struct {
  /**
   * The best fit.
   */
  brdfit_result_f64 best;
  /**
   * Number of distinct minima that were written.
   */
  size_t minima;
  /**
   * Evaluations of the model without derivatives.
   */
  uint32_t cost_passes;
  /**
   * Evaluations with derivatives.
   */
  uint32_t linearize_passes;
} brdfit_found_f64;

/**
 * What the model needs to know of a pair of directions, first for the surface lobe, then for the volume lobe; dimensionless.
 */
typedef struct {
  /**
   * tan^2 theta_h and tan^2 theta_he (Eq. 13), 0 or more.
   */
  double tan2_theta_h[2];
  /**
   * cos theta_d and cos theta_de (Eq. 12), above 0, at most 1.
   */
  double cos_theta_d[2];
  /**
   * What else of f does not depend on the parameters, 0 or more.
   */
  double factor[2];
} brdfit_geometry_f64;

/**
 * A unit of the memory of a search under way, which takes BRDFIT_SEARCH(minima, fits) of them, one after the other; all of them together may be copied.
 */
typedef struct BRDFIT_ALIGNED(8) {
  /**
   * Not to be touched.
   */
  double opaque[2];
} brdfit_search_state_f64;

/**
 * What a fit knows of its parameters, for residuals of equal and independent errors. Where residuals wander along the angle, as those of most measured scans do, true errors are several times larger; the program brdfit estimates that, this does not.
 */
typedef struct {
  /**
   * Standard errors; 0 of parameters that are absent, held or on a bound (of kappa at 0 too), very large where nothing is known.
   */
  brdfit_params_f64 standard_errors;
  /**
   * Correlations, -1 to 1, row by row in the order of brdfit_params; 0 where one is absent or held.
   */
  double correlations[36];
  /**
   * Standard deviation of a residual; infinite without degrees of freedom.
   */
  double scale;
  /**
   * Ratio of the largest to the least eigenvalue of the scaled J'J, 1 or more.
   */
  double condition;
} brdfit_uncertainty_f64;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

/**
 * The version of the library, such as "0.2.0".
 */
const char *brdfit_version(void);

/**
 * What a brdfit_error means, in a few words; any other number gives "unknown error".
 */
const char *brdfit_error_text(int32_t error);

/**
 * What a brdfit_stop means, in a few words; any other number gives "unknown stop".
 */
const char *brdfit_stop_text(int32_t stop);

/**
 * Sets all options to their usual values.
 *
 * Errors: NULL, MISALIGNED.
 */
brdfit_error brdfit_options_init_f32(brdfit_options_f32 *options);

/**
 * Begins a scan without samples in `count` blocks, which stay the caller's, and must live as long as the scan.
 *
 * Errors: NULL, MISALIGNED, LENGTH.
 */
brdfit_error brdfit_scan_init_f32(brdfit_scan_f32 *scan,
                                  brdfit_block_f32 *blocks,
                                  size_t count);

/**
 * Adds samples. After an error those before the bad one have been added; scan->samples tells how many there are.
 *
 * Errors: NULL, MISALIGNED, LENGTH, FULL, NOT_FINITE, BEYOND_HORIZON, NOT_POSITIVE, NOT_BEGUN.
 */
brdfit_error brdfit_scan_add_f32(brdfit_scan_f32 *scan,
                                 const brdfit_sample_f32 *samples,
                                 size_t count);

/**
 * The BRDF of Eq. 14 with all terms, sr^-1, at least the smallest normal number; angles in radians as in brdfit_sample.
 *
 * Errors: NULL, MISALIGNED, NOT_FINITE, BEYOND_HORIZON, PARAMS.
 */
brdfit_error brdfit_brdf_f32(float theta_i,
                             float theta_s,
                             float delta_phi,
                             const brdfit_params_f32 *params,
                             float *brdf);

/**
 * The same of any model: BRDFIT_MODEL_BECKMANN or BRDFIT_MODEL_GGX.
 *
 * Errors: those of brdfit_brdf_f32(), and TERMS where there is no such model.
 */
brdfit_error brdfit_model_brdf_f32(uint32_t model,
                                   float theta_i,
                                   float theta_s,
                                   float delta_phi,
                                   const brdfit_params_f32 *params,
                                   float *brdf);

/**
 * A start worth a fit: number `index` of the sequence of options->seed, with the weights that fit best there. One pass. Null options are the usual ones.
 *
 * Errors: NULL, MISALIGNED, BOUNDS, TERMS, OPTIONS, TOO_FEW, NOT_BEGUN.
 */
brdfit_error brdfit_candidate_f32(const brdfit_scan_f32 *scan,
                                  const brdfit_options_f32 *options,
                                  uint64_t index,
                                  brdfit_params_f32 *start);

/**
 * Begins a fit at the point within the bounds that is nearest to `start`. One pass. Null options are the usual ones; they are copied into the fit.
 *
 * Errors: NULL, MISALIGNED, NOT_FINITE, BOUNDS, TERMS, OPTIONS, TOO_FEW, NOT_BEGUN.
 */
brdfit_error brdfit_fit_begin_f32(brdfit_fit_f32 *fit,
                                  const brdfit_scan_f32 *scan,
                                  const brdfit_params_f32 *start,
                                  const brdfit_options_f32 *options);

/**
 * Goes on with a fit for at most `passes` further passes (UINT32_MAX: until it ends), with the scan that it began with. A fit made in pieces ends with the same bits as one made at once. Nothing happens to a fit that has ended.
 *
 * Errors: NULL, MISALIGNED, TOO_FEW, NOT_BEGUN.
 */
brdfit_error brdfit_fit_run_f32(brdfit_fit_f32 *fit,
                                const brdfit_scan_f32 *scan,
                                uint32_t passes);

/**
 * Where a fit is: at any moment the best so far.
 *
 * Errors: NULL, MISALIGNED, NOT_BEGUN.
 */
brdfit_error brdfit_fit_result_f32(const brdfit_fit_f32 *fit, brdfit_result_f32 *result);

/**
 * Searches the global optimum, and writes the distinct minima that it met, best first and at most `capacity`. Without interest in them, give null and 0. Null options are the usual ones.
 *
 * This needs more stack than all others, whatever the number of samples: see README.md.
 *
 * Errors: NULL, MISALIGNED, LENGTH, BOUNDS, TERMS, OPTIONS, TOO_FEW, NOT_BEGUN, NO_FIT.
 */
brdfit_error brdfit_search_f32(const brdfit_scan_f32 *scan,
                               const brdfit_options_f32 *options,
                               brdfit_minimum_f32 *minima,
                               size_t capacity,
                               brdfit_found_f32 *found);

/**
 * What the model needs to know of a pair of directions, angles in radians as in brdfit_sample: for a table, so that firmware at known angles needs no trigonometry.
 *
 * Errors: NULL, MISALIGNED, NOT_FINITE, BEYOND_HORIZON.
 */
brdfit_error brdfit_geometry_init_f32(float theta_i,
                                      float theta_s,
                                      float delta_phi,
                                      brdfit_geometry_f32 *geometry);

/**
 * Adds a sample whose geometry is known; brdf and weight as in brdfit_sample.
 *
 * Errors: NULL, MISALIGNED, FULL, NOT_FINITE, BEYOND_HORIZON, NOT_POSITIVE, NOT_BEGUN.
 */
brdfit_error brdfit_scan_add_at_f32(brdfit_scan_f32 *scan,
                                    const brdfit_geometry_f32 *geometry,
                                    float brdf,
                                    float weight);

/**
 * Begins a search in steps, which remembers so many minima and has at most so many fits under way at a time, in `size` bytes of memory, as BRDFIT_SEARCH says: for example `static brdfit_search_state_f32 search[BRDFIT_SEARCH(4, 4)];` and `sizeof search, 4, 4`. No pass. Fewer minima change nothing but the table of them; with fewer than 4 fits a minimum is missed more often, and more are of no use. Null options are the usual ones; they are copied into the search.
 *
 * Errors: NULL, MISALIGNED, LENGTH (no minimum or more than 65535, no fit or more than 255), BOUNDS, OPTIONS, SMALL, TERMS.
 */
brdfit_error brdfit_search_begin_f32(brdfit_search_state_f32 *search,
                                     size_t size,
                                     uint32_t minima,
                                     uint32_t fits,
                                     const brdfit_options_f32 *options);

/**
 * Goes on with a search for at most `passes` passes over the scan, always the same one; sets `ended` to 1 if the search has ended, and else to 0. With all its steps it ends in the bits of brdfit_search_f32(). Nothing happens to a search that has ended.
 *
 * Errors: NULL, MISALIGNED, TOO_FEW, NOT_BEGUN.
 */
brdfit_error brdfit_search_step_f32(brdfit_search_state_f32 *search,
                                    const brdfit_scan_f32 *scan,
                                    uint32_t passes,
                                    uint32_t *ended);

/**
 * What a search has found so far, with minima as in brdfit_search_f32(); NO_FIT before its first fit.
 *
 * Errors: NULL, MISALIGNED, LENGTH, NOT_BEGUN, NO_FIT.
 */
brdfit_error brdfit_search_found_f32(brdfit_search_state_f32 *search,
                                     brdfit_minimum_f32 *minima,
                                     size_t capacity,
                                     brdfit_found_f32 *found);

/**
 * Ends a search where it is; what it has found stays.
 *
 * Errors: NULL, MISALIGNED, NOT_BEGUN.
 */
brdfit_error brdfit_search_abort_f32(brdfit_search_state_f32 *search);

/**
 * Writes the state of a search as bytes, with version and checksum, and how many they are: fewer than its memory has. LENGTH if there is no room for them; then bytes may have changed.
 *
 * Errors: NULL, MISALIGNED, LENGTH, NOT_BEGUN.
 */
brdfit_error brdfit_search_save_f32(brdfit_search_state_f32 *search,
                                    uint8_t *bytes,
                                    size_t capacity,
                                    size_t *length);

/**
 * Takes the state that was written, on this machine or another; minima, fits and options are those that the search began with. It goes on with the same bits. After an error the search is not begun.
 *
 * Errors: NULL, MISALIGNED, LENGTH, BOUNDS, TERMS, OPTIONS, SMALL, SAVED.
 */
brdfit_error brdfit_search_restore_f32(brdfit_search_state_f32 *search,
                                       size_t size,
                                       uint32_t minima,
                                       uint32_t fits,
                                       const brdfit_options_f32 *options,
                                       const uint8_t *bytes,
                                       size_t length);

/**
 * What a scan tells of parameters at their optimum `params`, with the options of the search or fit; null options are the usual ones. One pass.
 *
 * Errors: NULL, MISALIGNED, NOT_FINITE, PARAMS, BOUNDS, TERMS, OPTIONS, TOO_FEW, NOT_BEGUN.
 */
brdfit_error brdfit_uncertainty_at_f32(const brdfit_scan_f32 *scan,
                                       const brdfit_options_f32 *options,
                                       const brdfit_params_f32 *params,
                                       brdfit_uncertainty_f32 *uncertainty);

/**
 * Sets all options to their usual values.
 *
 * Errors: NULL, MISALIGNED.
 */
brdfit_error brdfit_options_init_f64(brdfit_options_f64 *options);

/**
 * Begins a scan without samples in `count` blocks, which stay the caller's, and must live as long as the scan.
 *
 * Errors: NULL, MISALIGNED, LENGTH.
 */
brdfit_error brdfit_scan_init_f64(brdfit_scan_f64 *scan,
                                  brdfit_block_f64 *blocks,
                                  size_t count);

/**
 * Adds samples. After an error those before the bad one have been added; scan->samples tells how many there are.
 *
 * Errors: NULL, MISALIGNED, LENGTH, FULL, NOT_FINITE, BEYOND_HORIZON, NOT_POSITIVE, NOT_BEGUN.
 */
brdfit_error brdfit_scan_add_f64(brdfit_scan_f64 *scan,
                                 const brdfit_sample_f64 *samples,
                                 size_t count);

/**
 * The BRDF of Eq. 14 with all terms, sr^-1, at least the smallest normal number; angles in radians as in brdfit_sample.
 *
 * Errors: NULL, MISALIGNED, NOT_FINITE, BEYOND_HORIZON, PARAMS.
 */
brdfit_error brdfit_brdf_f64(double theta_i,
                             double theta_s,
                             double delta_phi,
                             const brdfit_params_f64 *params,
                             double *brdf);

/**
 * The same of any model: BRDFIT_MODEL_BECKMANN or BRDFIT_MODEL_GGX.
 *
 * Errors: those of brdfit_brdf_f64(), and TERMS where there is no such model.
 */
brdfit_error brdfit_model_brdf_f64(uint32_t model,
                                   double theta_i,
                                   double theta_s,
                                   double delta_phi,
                                   const brdfit_params_f64 *params,
                                   double *brdf);

/**
 * A start worth a fit: number `index` of the sequence of options->seed, with the weights that fit best there. One pass. Null options are the usual ones.
 *
 * Errors: NULL, MISALIGNED, BOUNDS, TERMS, OPTIONS, TOO_FEW, NOT_BEGUN.
 */
brdfit_error brdfit_candidate_f64(const brdfit_scan_f64 *scan,
                                  const brdfit_options_f64 *options,
                                  uint64_t index,
                                  brdfit_params_f64 *start);

/**
 * Begins a fit at the point within the bounds that is nearest to `start`. One pass. Null options are the usual ones; they are copied into the fit.
 *
 * Errors: NULL, MISALIGNED, NOT_FINITE, BOUNDS, TERMS, OPTIONS, TOO_FEW, NOT_BEGUN.
 */
brdfit_error brdfit_fit_begin_f64(brdfit_fit_f64 *fit,
                                  const brdfit_scan_f64 *scan,
                                  const brdfit_params_f64 *start,
                                  const brdfit_options_f64 *options);

/**
 * Goes on with a fit for at most `passes` further passes (UINT32_MAX: until it ends), with the scan that it began with. A fit made in pieces ends with the same bits as one made at once. Nothing happens to a fit that has ended.
 *
 * Errors: NULL, MISALIGNED, TOO_FEW, NOT_BEGUN.
 */
brdfit_error brdfit_fit_run_f64(brdfit_fit_f64 *fit,
                                const brdfit_scan_f64 *scan,
                                uint32_t passes);

/**
 * Where a fit is: at any moment the best so far.
 *
 * Errors: NULL, MISALIGNED, NOT_BEGUN.
 */
brdfit_error brdfit_fit_result_f64(const brdfit_fit_f64 *fit, brdfit_result_f64 *result);

/**
 * Searches the global optimum, and writes the distinct minima that it met, best first and at most `capacity`. Without interest in them, give null and 0. Null options are the usual ones.
 *
 * This needs more stack than all others, whatever the number of samples: see README.md.
 *
 * Errors: NULL, MISALIGNED, LENGTH, BOUNDS, TERMS, OPTIONS, TOO_FEW, NOT_BEGUN, NO_FIT.
 */
brdfit_error brdfit_search_f64(const brdfit_scan_f64 *scan,
                               const brdfit_options_f64 *options,
                               brdfit_minimum_f64 *minima,
                               size_t capacity,
                               brdfit_found_f64 *found);

/**
 * What the model needs to know of a pair of directions, angles in radians as in brdfit_sample: for a table, so that firmware at known angles needs no trigonometry.
 *
 * Errors: NULL, MISALIGNED, NOT_FINITE, BEYOND_HORIZON.
 */
brdfit_error brdfit_geometry_init_f64(double theta_i,
                                      double theta_s,
                                      double delta_phi,
                                      brdfit_geometry_f64 *geometry);

/**
 * Adds a sample whose geometry is known; brdf and weight as in brdfit_sample.
 *
 * Errors: NULL, MISALIGNED, FULL, NOT_FINITE, BEYOND_HORIZON, NOT_POSITIVE, NOT_BEGUN.
 */
brdfit_error brdfit_scan_add_at_f64(brdfit_scan_f64 *scan,
                                    const brdfit_geometry_f64 *geometry,
                                    double brdf,
                                    double weight);

/**
 * Begins a search in steps, which remembers so many minima and has at most so many fits under way at a time, in `size` bytes of memory, as BRDFIT_SEARCH says: for example `static brdfit_search_state_f64 search[BRDFIT_SEARCH(4, 4)];` and `sizeof search, 4, 4`. No pass. Fewer minima change nothing but the table of them; with fewer than 4 fits a minimum is missed more often, and more are of no use. Null options are the usual ones; they are copied into the search.
 *
 * Errors: NULL, MISALIGNED, LENGTH (no minimum or more than 65535, no fit or more than 255), BOUNDS, OPTIONS, SMALL, TERMS.
 */
brdfit_error brdfit_search_begin_f64(brdfit_search_state_f64 *search,
                                     size_t size,
                                     uint32_t minima,
                                     uint32_t fits,
                                     const brdfit_options_f64 *options);

/**
 * Goes on with a search for at most `passes` passes over the scan, always the same one; sets `ended` to 1 if the search has ended, and else to 0. With all its steps it ends in the bits of brdfit_search_f64(). Nothing happens to a search that has ended.
 *
 * Errors: NULL, MISALIGNED, TOO_FEW, NOT_BEGUN.
 */
brdfit_error brdfit_search_step_f64(brdfit_search_state_f64 *search,
                                    const brdfit_scan_f64 *scan,
                                    uint32_t passes,
                                    uint32_t *ended);

/**
 * What a search has found so far, with minima as in brdfit_search_f64(); NO_FIT before its first fit.
 *
 * Errors: NULL, MISALIGNED, LENGTH, NOT_BEGUN, NO_FIT.
 */
brdfit_error brdfit_search_found_f64(brdfit_search_state_f64 *search,
                                     brdfit_minimum_f64 *minima,
                                     size_t capacity,
                                     brdfit_found_f64 *found);

/**
 * Ends a search where it is; what it has found stays.
 *
 * Errors: NULL, MISALIGNED, NOT_BEGUN.
 */
brdfit_error brdfit_search_abort_f64(brdfit_search_state_f64 *search);

/**
 * Writes the state of a search as bytes, with version and checksum, and how many they are: fewer than its memory has. LENGTH if there is no room for them; then bytes may have changed.
 *
 * Errors: NULL, MISALIGNED, LENGTH, NOT_BEGUN.
 */
brdfit_error brdfit_search_save_f64(brdfit_search_state_f64 *search,
                                    uint8_t *bytes,
                                    size_t capacity,
                                    size_t *length);

/**
 * Takes the state that was written, on this machine or another; minima, fits and options are those that the search began with. It goes on with the same bits. After an error the search is not begun.
 *
 * Errors: NULL, MISALIGNED, LENGTH, BOUNDS, TERMS, OPTIONS, SMALL, SAVED.
 */
brdfit_error brdfit_search_restore_f64(brdfit_search_state_f64 *search,
                                       size_t size,
                                       uint32_t minima,
                                       uint32_t fits,
                                       const brdfit_options_f64 *options,
                                       const uint8_t *bytes,
                                       size_t length);

/**
 * What a scan tells of parameters at their optimum `params`, with the options of the search or fit; null options are the usual ones. One pass.
 *
 * Errors: NULL, MISALIGNED, NOT_FINITE, PARAMS, BOUNDS, TERMS, OPTIONS, TOO_FEW, NOT_BEGUN.
 */
brdfit_error brdfit_uncertainty_at_f64(const brdfit_scan_f64 *scan,
                                       const brdfit_options_f64 *options,
                                       const brdfit_params_f64 *params,
                                       brdfit_uncertainty_f64 *uncertainty);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* BRDFIT_H */

/* The sizes that the library was built with. */
#if defined(__cplusplus) && __cplusplus >= 201103L
#define BRDFIT_ASSERT(condition) static_assert(condition, #condition)
#elif defined(__STDC_VERSION__) && __STDC_VERSION__ >= 201112L
#define BRDFIT_ASSERT(condition) _Static_assert(condition, #condition)
#endif
#ifdef BRDFIT_ASSERT
BRDFIT_ASSERT(sizeof(float) == 4 && sizeof(double) == 8);
BRDFIT_ASSERT(sizeof(brdfit_error) == 4 && sizeof(brdfit_stop) == 4);
BRDFIT_ASSERT(sizeof(brdfit_block_f32) == BRDFIT_BLOCK_SIZE_F32);
BRDFIT_ASSERT(sizeof(brdfit_block_f64) == BRDFIT_BLOCK_SIZE_F64);
BRDFIT_ASSERT(sizeof(brdfit_fit_f32) == BRDFIT_FIT_SIZE_F32);
BRDFIT_ASSERT(sizeof(brdfit_fit_f64) == BRDFIT_FIT_SIZE_F64);
BRDFIT_ASSERT(sizeof(brdfit_search_state_f32) == 8 && sizeof(brdfit_search_state_f64) == 16);
BRDFIT_ASSERT(sizeof(brdfit_geometry_f32) == 24 && sizeof(brdfit_geometry_f64) == 48);
BRDFIT_ASSERT(sizeof(brdfit_uncertainty_f32) == 176 && sizeof(brdfit_uncertainty_f64) == 352);
BRDFIT_ASSERT(sizeof(brdfit_sample_f32) == 20 && sizeof(brdfit_sample_f64) == 40);
BRDFIT_ASSERT(sizeof(brdfit_params_f32) == 24 && sizeof(brdfit_params_f64) == 48);
BRDFIT_ASSERT(sizeof(brdfit_options_f32) == 88 && sizeof(brdfit_options_f64) == 144);
BRDFIT_ASSERT(sizeof(brdfit_result_f32) == 36 && sizeof(brdfit_result_f64) == 64);
BRDFIT_ASSERT(sizeof(brdfit_minimum_f32) == 32 && sizeof(brdfit_minimum_f64) == 64);
#endif
#undef BRDFIT_ASSERT
