/* stickslip: elastoplastic friction for finite-element codes, C interface.
 *
 * Every function is a function of its arguments alone and may be called from any number of threads.
 * Component 1 is normal, then tangential 1 and 2. Tractions are those that the contact transmits,
 * positive in tension. On a negative status no argument has been touched; in a batch, none of that point's. */
#ifndef STICKSLIP_FRICTION_H
#define STICKSLIP_FRICTION_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum friction_status {
    FRICTION_OK = 0,               /* solved, unique */
    FRICTION_SNAP_BACK = 1,        /* solved, but several equilibria exist: cut the step */
    FRICTION_BAD_SIZE = -1,        /* an array has the wrong size */
    FRICTION_BAD_LAW = -2,         /* props[0] names no law */
    FRICTION_BAD_PROPERTY = -3,    /* a material constant is out of range or not finite */
    FRICTION_BAD_INCREMENT = -4,   /* du, pressure or dtime out of range or not finite */
    FRICTION_BAD_STATE = -5,       /* statev holds what no update wrote */
    FRICTION_NO_CONVERGENCE = -6,  /* no equilibrium found */
    FRICTION_BAD_NORMAL = -7,      /* the normal is not a unit vector */
    FRICTION_NULL_POINTER = -8,    /* a pointer argument is NULL */
    FRICTION_ZERO_TIME_INCREMENT = -9,  /* the law depends on the slip rate and needs dtime > 0 */
    FRICTION_BAD_AXIS = -10,       /* orthotropic friction where the axes of the interface are unknown */
    FRICTION_NO_RATE = -11         /* slip starts with a jump, and has no rate */
};

/* Friction update of one contact point.
 *   ndir      components of du: 2 or 3
 *   du        increment of relative displacement, ndir numbers [L]
 *   dtime     increment of time, >= 0 [T]
 *   nprops    number of material constants
 *   props     number of the law, alpha_n, alpha_t, then its own (docs/laws.md), e.g. of law 1, subloading:
 *             mu_s, mu_k, kappa, xi, m[, mu_0]; options (docs/law_options.md) follow them; numbers after those
 *             of the law have to be finite and are not used
 *   nstatv    number of state variables, 8 or more
 *   statev    state at the start in, at the end out; all zero = virgin:
 *             status (0 virgin, 1 stick, 2 slip, 3 open), u_n, u_et1, u_et2, mu, R, slip, dissipated energy
 *   traction  at the end of the increment, ndir numbers [F/L^2]
 *   tangent   d(traction)/d(du), ndir x ndir numbers, column-major, unsymmetric [F/L^3]
 * Returns a friction_status. */
int friction_update(int ndir, const double *du, double dtime, int nprops, const double *props,
                    int nstatv, double *statev, double *traction, double *tangent);

/* Friction update of n contact points, all with the same constants and the same increment of time.
 * Arrays are component-major: component j of point i is du[j*n + i]; tangent entry (i,j) of point k is
 * tangent[(j*ndir + i)*n + k]. `status` (n numbers) receives a friction_status for each point; bad input at
 * a point leaves that point's data untouched and harms no other point. Sizes as in friction_update.
 * Large batches are shared out among OMP_NUM_THREADS threads; the results do not depend on how many.
 * Returns the worst status: the lowest negative one, else FRICTION_SNAP_BACK where a point has it, else
 * FRICTION_OK. */
int friction_update_batch(int64_t n, int ndir, const double *du, double dtime, int nprops, const double *props,
                          int nstatv, double *statev, double *traction, double *tangent, int *status);

/* The same with constants of its own at each point: constant k of point i is props[k*n + i]. The fast way is
 * for points that share the law and its choices (scheme, u_of_r, evolution, direction). */
int friction_update_batch_props(int64_t n, int ndir, const double *du, double dtime, int nprops,
                                const double *props, int nstatv, double *statev, double *traction,
                                double *tangent, int *status);

/* friction_update_batch for arrays that keep each point's numbers together, as C and numpy order them: component j of
 * point i is du[i*ndir + j], state variable j of point i is statev[i*nstatv + j], and
 * d(traction i)/d(du j) of point k is tangent[(k*ndir + i)*ndir + j]. */
int friction_update_points(int64_t n, int ndir, const double *du, double dtime, int nprops, const double *props,
                           int nstatv, double *statev, double *traction, double *tangent, int *status);

/* Slip rates of n points without a contact spring: v >= 0 with tau - damping v = friction(v, internal, pressure),
 * and the rate of the internal variable at that v. For rate-and-state friction (laws 4, 7 and 8) alone; others
 * get FRICTION_BAD_LAW.
 *   tau            magnitudes of the tangential traction, >= 0, n numbers [F/L^2]
 *   pressure       >= 0, n numbers [F/L^2]
 *   damping        radiation damping, >= 0, e.g. G/(2 c_s) [F T/L^3]
 *   nprops, props  constants of each point as in friction_update, 8 or more; constant k of point i is
 *                  props[k*n + i]; the springs alpha_n and alpha_t are not used
 *   internal       theta, > 0, n numbers [T]
 *   rate           v, n numbers [L/T]
 *   internal_rate  d(theta)/dt, n numbers [-]
 *   status         a friction_status for each point; bad input at a point leaves its results untouched and harms
 *                  no other point. FRICTION_NO_CONVERGENCE: a slip rate beyond the range of the arithmetic
 * Threads and the value returned as in friction_update_batch. */
int friction_slip_rates(int64_t n, const double *tau, const double *pressure, double damping, int nprops,
                        const double *props, const double *internal, double *rate, double *internal_rate,
                        int *status);

/* The tangential part alone, for hosts that hand in the pressure.
 *   ndir      tangential components: 1 or 2
 *   du        increment of tangential displacement, ndir numbers [L]
 *   pressure  at the end of the increment; <= 0 is an open contact [F/L^2]
 *   tau       tangential traction, ndir numbers [F/L^2]
 *   dtau_ddu  d(tau)/d(du), ndir x ndir numbers, column-major [F/L^3]
 *   dtau_dp   d(tau)/d(pressure), ndir numbers [-]
 * The others as in friction_update. Returns a friction_status. */
int friction_tangential(int ndir, const double *du, double pressure, double dtime, int nprops, const double *props,
                        int nstatv, double *statev, double *tau, double *dtau_ddu, double *dtau_dp);

/* Continuous time: rates of the state of one contact point for a relative velocity, to which friction_update tends as
 * dtime tends to zero (docs/theory.md, section 10).
 *   ndir      components of velocity: 2 or 3
 *   velocity  relative velocity, ndir numbers [L/T]
 *   statev    state, nstatv numbers, 8 or more; not changed
 *   rates     rates of statev[1] to statev[7]; rates[0] = 0; 8 numbers, out
 * The others as in friction_update. Returns a friction_status. */
int friction_rates(int ndir, const double *velocity, int nprops, const double *props, int nstatv, const double *statev,
                   double *rates);

/* What is to be known about the laws, for those who read constants, describe them, or check them. Laws are numbered
 * from 1 to friction_law_count(). */
int friction_law_count(void);

typedef struct {
    char name[24];           /* as in the program's input: "subloading", ... */
    char internal[16];       /* name of the internal variable, statev[5]; "R" for laws without one */
    char internal_unit[8];
    int has_internal;        /* 0: the law has none, and statev[5] is 0 */
    int constants;           /* how many numbers props can have, options and the law's number included */
} friction_law_facts;

/* The facts of a law. Returns FRICTION_OK or FRICTION_BAD_LAW. */
int friction_get_law(int law, friction_law_facts *facts);

/* What a law is, in words, of at most length - 1 characters; 81 are room for every text.
 * Returns FRICTION_OK, FRICTION_BAD_LAW, or FRICTION_BAD_SIZE for length < 1. */
int friction_get_law_summary(int law, int length, char *text);

typedef struct {
    char name[24];           /* "law", "alpha_n", "alpha_t", "mu_s", ... */
    char unit[8];            /* in force F, length L, time T: "F/L^3", "T/L", "-", ... */
    char meaning[72];        /* in words */
    char rule[104];          /* in words: "must be >= mu_k", ... */
    char default_text[24];   /* in words: "0", "mu_s", "d_c/v0"; "" where there is none */
    char words[72];          /* of a choice: those that stand for 0, 1, ... in the program's input */
    double lower, upper;     /* range; where a constant has to be > 0, `lower` is the least number taken for such; the
                              * rule may ask for more, or allow 0, too */
    int optional;            /* 1: it may be left out, with all that follow it */
    int choice;              /* 1: a whole number, one of the words */
} friction_constant_facts;

/* The facts of the constant props[place] of a law, place = 0 to constants - 1.
 * Returns FRICTION_OK, FRICTION_BAD_LAW, or FRICTION_BAD_SIZE for a place that does not exist. */
int friction_get_constant(int law, int place, friction_constant_facts *facts);

/* The default of the constant props[place], which may follow from those before it: props holds nprops numbers, as many as
 * are known. Returns FRICTION_OK, or FRICTION_BAD_PROPERTY where there is none. */
int friction_get_default(int nprops, const double *props, int place, double *value);

/* Do the constants obey the rules of their law? The text, of at most length - 1 characters, says which one breaks which
 * rule ("m must be > 0"); "" if none does. 96 characters are room for every text; with length = 0, text may be NULL.
 * Returns FRICTION_OK, or what an update with these constants returns. */
int friction_check(int nprops, const double *props, int length, char *text);

/* What a status says, in one line; the text is constant and not to be freed. */
const char *friction_message(int status);

/* Version of the library, "major.minor.patch". */
const char *friction_version(void);

#ifdef __cplusplus
}
#endif

#endif
