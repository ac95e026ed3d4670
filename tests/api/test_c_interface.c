/* The C interface as a C program sees it: same numbers as the law demands, NULL is a code, texts are texts. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "friction.h"

static const double props[9] = {1, 1000, 800, 0.45, 0.25, 8, 0.2, 60, 0.3};

static void update_slides_on_the_subloading_surface(void)
{
    double statev[8] = {0}, traction[3], tangent[9];
    const double press[3] = {-2e-3, 0, 0}, slide[3] = {0, 3e-3, 4e-3};

    CHECK(friction_update(3, press, 0.1, 9, props, 8, statev, traction, tangent) == FRICTION_OK);
    CHECK(traction[0] == -2.0 && statev[0] == 1 && tangent[0] == 1000 && tangent[4] == 800);
    CHECK(friction_update(3, slide, 0.1, 9, props, 8, statev, traction, tangent) == FRICTION_OK);
    CHECK(statev[0] == 2);
    CHECK(fabs(hypot(traction[1], traction[2]) - statev[5] * statev[4] * 2.0) < 1e-14);
    CHECK(fabs(traction[2] / traction[1] - 4.0 / 3.0) < 1e-14);
    /* column-major: entry (i,j) at j*3 + i; pressure drives friction, friction does not drive pressure */
    CHECK(tangent[1] < 0 && tangent[2] < 0 && tangent[3] == 0 && tangent[6] == 0);
    /* slip + elastic displacement = what was imposed */
    CHECK(fabs(statev[6] + hypot(statev[2], statev[3]) - 5e-3) < 1e-16);
}

static void tangential_is_the_same_with_the_pressure_handed_in(void)
{
    double a[8] = {0}, b[8] = {0}, traction[2], tangent[4], tau, by_du, by_p;
    const double press[2] = {-2e-3, 0}, slide[2] = {0, 3e-3}, nothing = 0, along = 3e-3;

    friction_update(2, press, 0.1, 9, props, 8, a, traction, tangent);
    CHECK(friction_tangential(1, &nothing, 2.0, 0.1, 9, props, 8, b, &tau, &by_du, &by_p) == FRICTION_OK);
    friction_update(2, slide, 0.1, 9, props, 8, a, traction, tangent);
    CHECK(friction_tangential(1, &along, 2.0, 0.1, 9, props, 8, b, &tau, &by_du, &by_p) == FRICTION_OK);
    CHECK(tau == traction[1] && by_du == tangent[3] && fabs(by_p + tangent[1] / 1000) < 1e-15);
    CHECK(memcmp(a, b, sizeof a) == 0);
}

static void a_batch_is_component_major(void)
{
    enum { n = 3 };
    double statev[8 * n] = {0}, traction[3 * n], tangent[9 * n], one[8] = {0}, t1[3], c1[9];
    const double press[3] = {-2e-3, 3e-3, 4e-3};
    double du[3 * n] = {0};
    int status[n], i, j, k = 1;

    for (j = 0; j < 3; j++)
        du[j * n + k] = press[j];
    CHECK(friction_update_batch(n, 3, du, 0.1, 9, props, 8, statev, traction, tangent, status) == FRICTION_OK);
    friction_update(3, press, 0.1, 9, props, 8, one, t1, c1);
    for (j = 0; j < 8; j++)
        CHECK(fabs(statev[j * n + k] - one[j]) < 1e-15);
    for (j = 0; j < 3; j++) {
        CHECK(fabs(traction[j * n + k] - t1[j]) < 1e-14);
        for (i = 0; i < 3; i++)
            CHECK(fabs(tangent[(j * 3 + i) * n + k] - c1[j * 3 + i]) < 1e-11);
    }
    CHECK(statev[0] == 3 && statev[2] == 3 && traction[0] == 0);

    du[0] = NAN;
    CHECK(friction_update_batch(n, 3, du, 0.1, 9, props, 8, statev, traction, tangent, status)
          == FRICTION_BAD_INCREMENT);
    CHECK(status[0] == FRICTION_BAD_INCREMENT && status[1] == FRICTION_OK && status[2] == FRICTION_OK);
    CHECK(friction_update_batch(0, 3, du, 0.1, 9, props, 8, statev, traction, tangent, status) == FRICTION_OK);
    CHECK(friction_update_batch(-1, 3, du, 0.1, 9, props, 8, statev, traction, tangent, status) == FRICTION_BAD_SIZE);
    CHECK(friction_update_batch(n, 3, NULL, 0.1, 9, props, 8, statev, traction, tangent, status)
          == FRICTION_NULL_POINTER);
    CHECK(friction_update_batch(n, 3, du, 0.1, 9, props, 8, statev, traction, tangent, NULL)
          == FRICTION_NULL_POINTER);
}

/* Wherever the point stands: the lowest error, else snap-back, else ok; the same point by point and in a batch. */
static void a_batch_returns_the_worst_status(void)
{
    static const double brittle[8] = {1, 1000, 100, .4, .2, 100, 0, 1e4};
    static const struct { double du[3], slip; int status; } kinds[4] = {
        {{-.1, .01, 0}, 0, FRICTION_OK}, {{-.1, .32, 0}, 0, FRICTION_SNAP_BACK},
        {{-.1, NAN, 0}, 0, FRICTION_BAD_INCREMENT}, {{-.1, .01, 0}, -1, FRICTION_BAD_STATE}};
    static const int cases[7][4] = {{0, 0, 0, FRICTION_OK}, {1, 0, 0, FRICTION_SNAP_BACK}, {0, 0, 1, FRICTION_SNAP_BACK},
                                    {2, 3, 1, FRICTION_BAD_STATE}, {3, 2, 0, FRICTION_BAD_STATE},
                                    {1, 0, 2, FRICTION_BAD_INCREMENT}, {0, 3, 2, FRICTION_BAD_STATE}};
    double du[9], statev[24], points_du[9], points_statev[24], traction[9], tangent[27];
    int status[3], i, j, k;

    for (k = 0; k < 7; k++) {
        memset(statev, 0, sizeof statev);
        memset(points_statev, 0, sizeof points_statev);
        for (i = 0; i < 3; i++) {
            for (j = 0; j < 3; j++)
                du[j * 3 + i] = points_du[i * 3 + j] = kinds[cases[k][i]].du[j];
            statev[6 * 3 + i] = points_statev[i * 8 + 6] = kinds[cases[k][i]].slip;
        }
        CHECK(friction_update_batch(3, 3, du, 0, 8, brittle, 8, statev, traction, tangent, status) == cases[k][3]);
        for (i = 0; i < 3; i++)
            CHECK(status[i] == kinds[cases[k][i]].status);
        CHECK(friction_update_points(3, 3, points_du, 0, 8, brittle, 8, points_statev, traction, tangent, status)
              == cases[k][3]);
        for (i = 0; i < 3; i++)
            CHECK(status[i] == kinds[cases[k][i]].status);
    }
}

static void points_are_in_c_order(void)
{
    enum { n = 3, k = 1 };
    const double press[3] = {-0.01, 0.002, 0.001};
    double one[8] = {0}, t1[3], c1[9];
    double du[n][3], statev[n][8] = {{0}}, traction[n][3], tangent[n][3][3];
    int status[n], i, j;

    for (i = 0; i < n; i++)
        for (j = 0; j < 3; j++)
            du[i][j] = press[j] / (1 + abs(i - k));
    du[0][2] = NAN;
    CHECK(friction_update_points(n, 3, du[0], 0.1, 9, props, 8, statev[0], traction[0], tangent[0][0], status)
          == FRICTION_BAD_INCREMENT);
    CHECK(status[0] == FRICTION_BAD_INCREMENT && status[1] == FRICTION_OK && status[2] == FRICTION_OK);
    friction_update(3, press, 0.1, 9, props, 8, one, t1, c1);
    for (j = 0; j < 8; j++)
        CHECK(fabs(statev[k][j] - one[j]) < 1e-15);
    for (i = 0; i < 3; i++) {
        CHECK(fabs(traction[k][i] - t1[i]) < 1e-14);
        for (j = 0; j < 3; j++)
            CHECK(fabs(tangent[k][i][j] - c1[j * 3 + i]) < 1e-11);
    }
    CHECK(friction_update_points(-1, 3, du[0], 0.1, 9, props, 8, statev[0], traction[0], tangent[0][0], status)
          == FRICTION_BAD_SIZE);
    CHECK(friction_update_points(n, 3, du[0], 0.1, 9, props, 8, statev[0], traction[0], NULL, status)
          == FRICTION_NULL_POINTER);
}

static void rates_are_what_the_update_tends_to(void)
{
    const double press[3] = {-0.01, 0.002, 0}, v[3] = {0, 1, 0}, dt = 1e-8;
    double statev[8] = {0}, rates[8], after[8], traction[3], tangent[9], du[3];
    int j;

    friction_update(3, press, 0.1, 9, props, 8, statev, traction, tangent);
    CHECK(friction_rates(3, v, 9, props, 8, statev, rates) == FRICTION_OK);
    for (j = 0; j < 8; j++)
        after[j] = statev[j];
    for (j = 0; j < 3; j++)
        du[j] = v[j] * dt;
    friction_update(3, du, dt, 9, props, 8, after, traction, tangent);
    CHECK(rates[0] == 0 && rates[6] > 0);
    for (j = 1; j < 8; j++)
        CHECK(fabs((after[j] - statev[j]) / dt - rates[j]) < 1e-3 * (1 + fabs(rates[j])));
    CHECK(friction_rates(3, NULL, 9, props, 8, statev, rates) == FRICTION_NULL_POINTER);
    CHECK(friction_rates(3, v, 9, props, 8, statev, NULL) == FRICTION_NULL_POINTER);
    CHECK(friction_rates(4, v, 9, props, 8, statev, rates) == FRICTION_BAD_SIZE);
}

static void slip_rates_balance_the_traction(void)
{
    enum { n = 2 };
    /* points first: constant k of point i is at k*n + i; d_c differs */
    const double constants[8 * n] = {4, 4, 0, 0, 0, 0, 0.01, 0.01, 0.015, 0.015, 0.008, 0.016, 1e-6, 1e-6, 0.6, 0.6};
    const double tau[n] = {30e6, 31e6}, pressure[n] = {50e6, 50e6}, theta[n] = {1e6, 2e6}, damping = 4.6e6;
    double rate[n] = {7, 7}, theta_rate[n], friction;
    int status[n], i;

    CHECK(friction_slip_rates(n, tau, pressure, damping, 8, constants, theta, rate, theta_rate, status) == FRICTION_OK);
    for (i = 0; i < n; i++) {
        friction = 0.01 * 50e6 * asinh(rate[i] / 2e-6 * exp((0.6 + 0.015 * log(125.0)) / 0.01));
        CHECK(status[i] == FRICTION_OK && fabs(tau[i] - damping * rate[i] - friction) < 1e-6);
        CHECK(fabs(theta_rate[i] - (1 - rate[i] * 1.25e8)) < 1e-14);
    }
    CHECK(friction_slip_rates(n, tau, pressure, damping, 7, constants, theta, rate, theta_rate, status)
          == FRICTION_BAD_SIZE);
    CHECK(friction_slip_rates(-1, tau, pressure, damping, 8, constants, theta, rate, theta_rate, status)
          == FRICTION_BAD_SIZE);
    CHECK(friction_slip_rates(n, tau, pressure, damping, 8, constants, theta, rate, NULL, status)
          == FRICTION_NULL_POINTER);
    CHECK(friction_slip_rates(1, tau, pressure, damping, 8, props, theta, rate, theta_rate, status)
          == FRICTION_BAD_LAW);
}

/* Each pointer alone, then each size alone, which is told first. */
static void every_null_and_every_negative_size_is_told(void)
{
    enum { pointers = 7, n = 1 };
    double numbers[32] = {0}, *p[pointers];
    int ok[n], *s, i, k;

    for (i = 0; i < pointers; i++) {
        for (k = 0; k < pointers; k++)
            p[k] = k == i ? NULL : numbers;
        s = i == 5 ? NULL : ok;
        if (i < 5)
            CHECK(friction_update(3, p[0], 0, 9, p[1], 8, p[2], p[3], p[4]) == FRICTION_NULL_POINTER);
        if (i < 6) {
            CHECK(friction_tangential(2, p[0], 1, 0, 9, p[1], 8, p[2], p[3], p[4], p[5]) == FRICTION_NULL_POINTER);
            CHECK(friction_update_batch(n, 3, p[0], 0, 9, p[1], 8, p[2], p[3], p[4], s) == FRICTION_NULL_POINTER);
            CHECK(friction_update_batch_props(n, 3, p[0], 0, 9, p[1], 8, p[2], p[3], p[4], s)
                  == FRICTION_NULL_POINTER);
            CHECK(friction_update_points(n, 3, p[0], 0, 9, p[1], 8, p[2], p[3], p[4], s) == FRICTION_NULL_POINTER);
        }
        if (i < 4)
            CHECK(friction_rates(3, p[0], 9, p[1], 8, p[2], p[3]) == FRICTION_NULL_POINTER);
        CHECK(friction_slip_rates(n, p[0], p[1], 1, 8, p[2], p[3], p[4], p[6], s) == FRICTION_NULL_POINTER);
    }
    for (i = 0; i < 4; i++) {
        const int64_t points = i == 3 ? -1 : 1;
        const int ndir = i == 0 ? -1 : 3, nprops = i == 1 ? -1 : 9, nstatv = i == 2 ? -1 : 8;
        if (i < 3) {
            CHECK(friction_update(ndir, NULL, 0, nprops, NULL, nstatv, NULL, NULL, NULL) == FRICTION_BAD_SIZE);
            CHECK(friction_tangential(ndir, NULL, 1, 0, nprops, NULL, nstatv, NULL, NULL, NULL, NULL)
                  == FRICTION_BAD_SIZE);
            CHECK(friction_rates(ndir, NULL, nprops, NULL, nstatv, NULL, NULL) == FRICTION_BAD_SIZE);
        }
        CHECK(friction_update_batch(points, ndir, NULL, 0, nprops, NULL, nstatv, NULL, NULL, NULL, NULL)
              == FRICTION_BAD_SIZE);
        CHECK(friction_update_batch_props(points, ndir, NULL, 0, nprops, NULL, nstatv, NULL, NULL, NULL, NULL)
              == FRICTION_BAD_SIZE);
        CHECK(friction_update_points(points, ndir, NULL, 0, nprops, NULL, nstatv, NULL, NULL, NULL, NULL)
              == FRICTION_BAD_SIZE);
        if (points < 0 || nprops < 0)
            CHECK(friction_slip_rates(points, NULL, NULL, 1, nprops, NULL, NULL, NULL, NULL, NULL) == FRICTION_BAD_SIZE);
    }
}

static void bad_calls_are_codes_and_touch_nothing(void)
{
    double statev[8] = {0}, traction[3] = {7, 7, 7}, tangent[9] = {7}, bad[9];
    const double du[3] = {0, 0, 0}, zero[8] = {0};

    CHECK(friction_update(3, NULL, 0, 9, props, 8, statev, traction, tangent) == FRICTION_NULL_POINTER);
    CHECK(friction_update(3, du, 0, 9, NULL, 8, statev, traction, tangent) == FRICTION_NULL_POINTER);
    CHECK(friction_update(3, du, 0, 9, props, 8, NULL, traction, tangent) == FRICTION_NULL_POINTER);
    CHECK(friction_update(3, du, 0, 9, props, 8, statev, NULL, tangent) == FRICTION_NULL_POINTER);
    CHECK(friction_update(3, du, 0, 9, props, 8, statev, traction, NULL) == FRICTION_NULL_POINTER);
    CHECK(friction_tangential(2, du, 1, 0, 9, props, 8, statev, traction, tangent, NULL) == FRICTION_NULL_POINTER);
    CHECK(friction_update(4, du, 0, 9, props, 8, statev, traction, tangent) == FRICTION_BAD_SIZE);
    CHECK(friction_update(-1, du, 0, 9, props, 8, statev, traction, tangent) == FRICTION_BAD_SIZE);
    CHECK(friction_update(3, du, 0, 7, props, 8, statev, traction, tangent) == FRICTION_BAD_SIZE);
    CHECK(friction_update(3, du, 0, 9, props, 7, statev, traction, tangent) == FRICTION_BAD_SIZE);
    CHECK(friction_update(3, du, -1, 9, props, 8, statev, traction, tangent) == FRICTION_BAD_INCREMENT);
    CHECK(friction_update(3, du, NAN, 9, props, 8, statev, traction, tangent) == FRICTION_BAD_INCREMENT);
    memcpy(bad, props, sizeof bad);
    bad[0] = 999;
    CHECK(friction_update(3, du, 0, 9, bad, 8, statev, traction, tangent) == FRICTION_BAD_LAW);
    memcpy(bad, props, sizeof bad);
    bad[1] = -1;
    CHECK(friction_update(3, du, 0, 9, bad, 8, statev, traction, tangent) == FRICTION_BAD_PROPERTY);
    CHECK(memcmp(statev, zero, sizeof statev) == 0 && traction[0] == 7 && tangent[0] == 7);
    statev[0] = 5;
    CHECK(friction_update(3, du, 0, 9, props, 8, statev, traction, tangent) == FRICTION_BAD_STATE);
}

enum { most = 32 };
static const char *table;   /* constants of all laws for tests: law_constants.csv */

/* The constants of a law, in their order; returns how many there are in the table. */
static int read_constants(int number, const friction_law_facts *law, double *props)
{
    FILE *file = fopen(table, "r");
    friction_constant_facts constant;
    char name[24], key[24];
    double value;
    int i, found = 1;

    props[0] = number;
    if (!file)
        return 0;
    if (!fgets(name, sizeof name, file))   /* the heading */
        found = 0;
    while (fscanf(file, " %23[^,],%23[^,],%lf", name, key, &value) == 3)
        for (i = 1; i < law->constants && (strcmp(name, "every") == 0 || strcmp(name, law->name) == 0); i++)
            if (friction_get_constant(number, i, &constant) == FRICTION_OK && strcmp(constant.name, key) == 0) {
                props[i] = value;
                found++;
            }
    fclose(file);
    return found;
}

/* The ends of the ranges that are told: those of the stiffnesses are taken, what is outside any is refused. */
static void ranges_are_those_that_are_checked(void)
{
    friction_law_facts law;
    friction_constant_facts constant;
    double valid[most], props[most];
    int number, i;

    for (number = 1; number <= friction_law_count(); number++) {
        CHECK(friction_get_law(number, &law) == FRICTION_OK);
        CHECK(read_constants(number, &law, valid) == law.constants);
        for (i = 0; i < law.constants; i++) {
            CHECK(friction_get_constant(number, i, &constant) == FRICTION_OK);
            memcpy(props, valid, sizeof props);
            CHECK(friction_check(law.constants, props, 0, NULL) == FRICTION_OK);
            props[i] = 1.01 * constant.upper;
            CHECK(friction_check(law.constants, props, 0, NULL) < 0);
            props[i] = constant.lower > 0 ? 0.99 * constant.lower : -1;
            CHECK(friction_check(law.constants, props, 0, NULL) < 0);
            if (i != 1 && i != 2)
                continue;
            props[i] = constant.upper;
            CHECK(friction_check(law.constants, props, 0, NULL) == FRICTION_OK);
            props[i] = constant.lower;
            CHECK(friction_check(law.constants, props, 0, NULL) == FRICTION_OK);
        }
    }
}

static void laws_tell_their_constants(void)
{
    static const char *names[16] = {"law", "alpha_n", "alpha_t", "mu_s", "mu_k", "kappa", "xi", "m", "mu_0", "scheme",
                                    "u_of_r", "tau_max", "mu_ratio", "direction", "cohesion", "eta_t"};
    friction_law_facts law;
    friction_constant_facts constant;
    double value = 7;
    char summary[81];
    const double rate_state[8] = {4, 1, 1, .01, .02, 6, 2, .4}, subloading[4] = {1, 1, 1, .4}, unknown[1] = {999};
    int i;

    CHECK(friction_get_law(1, &law) == FRICTION_OK && strcmp(law.name, "subloading") == 0 && law.constants == 16);
    CHECK(strcmp(law.internal, "R") == 0 && law.has_internal == 1);
    for (i = 0; i < 16; i++)
        CHECK(friction_get_constant(1, i, &constant) == FRICTION_OK && strcmp(constant.name, names[i]) == 0);
    CHECK(friction_get_law(2, &law) == FRICTION_OK && law.has_internal == 0 && strcmp(law.internal, "R") == 0);
    CHECK(friction_get_law(4, &law) == FRICTION_OK && strcmp(law.internal, "theta") == 0
          && strcmp(law.internal_unit, "T") == 0);
    CHECK(friction_get_constant(4, 9, &constant) == FRICTION_OK && strcmp(constant.name, "theta_0") == 0);
    CHECK(constant.optional == 1 && constant.choice == 0 && constant.lower > 0 && constant.lower < 1e-90);
    CHECK(strcmp(constant.default_text, "d_c/v0") == 0 && strcmp(constant.rule, "must be > 0") == 0
          && strcmp(constant.unit, "T") == 0 && strcmp(constant.meaning, "theta of a virgin point") == 0);
    CHECK(friction_get_constant(4, 8, &constant) == FRICTION_OK && constant.choice == 1 && constant.upper == 1
          && strcmp(constant.words, "ageing slip") == 0 && strcmp(constant.default_text, "ageing") == 0);
    CHECK(friction_get_default(8, rate_state, 9, &value) == FRICTION_OK && value == 3);
    /* as many constants as the default takes are enough: d_c and v0, mu_s, none */
    CHECK(friction_get_default(7, rate_state, 9, &value) == FRICTION_OK && value == 3);
    CHECK(friction_get_default(4, subloading, 8, &value) == FRICTION_OK && value == .4);
    CHECK(friction_get_default(3, subloading, 8, &value) == FRICTION_BAD_PROPERTY);
    CHECK(friction_get_default(1, subloading, 9, &value) == FRICTION_OK && value == 0);
    CHECK(friction_get_default(4, subloading, 0, &value) == FRICTION_BAD_PROPERTY);
    CHECK(friction_get_default(1, unknown, 9, &value) == FRICTION_BAD_LAW);
    ranges_are_those_that_are_checked();
    CHECK(friction_get_law_summary(2, 81, summary) == FRICTION_OK
          && strcmp(summary, "Friction proportional to the pressure") == 0);
    CHECK(friction_get_law_summary(2, 9, summary) == FRICTION_OK && strcmp(summary, "Friction") == 0);
    CHECK(friction_get_law_summary(2, 1, summary) == FRICTION_OK && strcmp(summary, "") == 0);
    CHECK(friction_get_law_summary(friction_law_count(), 81, summary) == FRICTION_OK && strcmp(summary, "") != 0);
    CHECK(friction_get_law_summary(2, 9, summary) == FRICTION_OK);
    CHECK(friction_get_law_summary(2, 0, summary) == FRICTION_BAD_SIZE
          && friction_get_law_summary(0, 81, summary) == FRICTION_BAD_LAW
          && friction_get_law_summary(2, 81, NULL) == FRICTION_NULL_POINTER && strcmp(summary, "Friction") == 0);

    CHECK(friction_get_law(0, &law) == FRICTION_BAD_LAW && friction_get_law(friction_law_count() + 1, &law) == FRICTION_BAD_LAW);
    CHECK(friction_get_law(1, NULL) == FRICTION_NULL_POINTER);
    CHECK(friction_get_constant(friction_law_count() + 1, 0, &constant) == FRICTION_BAD_LAW);
    CHECK(friction_get_constant(1, 16, &constant) == FRICTION_BAD_SIZE);
    CHECK(friction_get_constant(1, -1, &constant) == FRICTION_BAD_SIZE);
    CHECK(friction_get_constant(1, 0, NULL) == FRICTION_NULL_POINTER);
    value = 7;
    CHECK(friction_get_default(8, rate_state, 3, &value) == FRICTION_BAD_PROPERTY && value == 7);
    CHECK(friction_get_default(6, rate_state, 9, &value) == FRICTION_BAD_PROPERTY && value == 7);
    CHECK(friction_get_default(8, rate_state, 15, &value) == FRICTION_BAD_SIZE);
    CHECK(friction_get_default(0, rate_state, 9, &value) == FRICTION_BAD_SIZE);
    CHECK(friction_get_default(8, NULL, 9, &value) == FRICTION_NULL_POINTER);
    CHECK(friction_get_default(8, rate_state, 9, NULL) == FRICTION_NULL_POINTER);
}

static void broken_rules_are_told(void)
{
    double bad[9];
    char text[96] = "untouched";

    CHECK(friction_check(9, props, 96, text) == FRICTION_OK && strcmp(text, "") == 0);
    memcpy(bad, props, sizeof bad);
    bad[8] = 0.46;
    CHECK(friction_check(9, bad, 96, text) == FRICTION_BAD_PROPERTY
          && strcmp(text, "mu_0 must be from mu_k to mu_s") == 0);
    CHECK(friction_check(9, bad, 8, text) == FRICTION_BAD_PROPERTY && strcmp(text, "mu_0 mu") == 0);
    CHECK(friction_check(9, bad, 0, NULL) == FRICTION_BAD_PROPERTY);
    CHECK(friction_check(7, props, 96, text) == FRICTION_BAD_SIZE && strcmp(text, "m is missing") == 0);
    bad[8] = NAN;
    CHECK(friction_check(9, bad, 96, text) == FRICTION_BAD_PROPERTY && strstr(text, "finite") != NULL);
    bad[0] = friction_law_count() + 1;
    bad[8] = 1;
    CHECK(friction_check(9, bad, 96, text) == FRICTION_BAD_LAW);
    CHECK(friction_check(9, NULL, 96, text) == FRICTION_NULL_POINTER);
    CHECK(friction_check(9, props, 96, NULL) == FRICTION_NULL_POINTER);
    CHECK(friction_check(-1, props, 96, text) == FRICTION_BAD_SIZE);
    CHECK(friction_check(9, props, -1, text) == FRICTION_BAD_SIZE);
}

static void texts_are_constant_c_strings(void)
{
    CHECK(strcmp(friction_message(FRICTION_OK), "success") == 0);
    CHECK(strstr(friction_message(FRICTION_NULL_POINTER), "NULL") != NULL);
    CHECK(strcmp(friction_message(12345), friction_message(-999)) == 0);
    CHECK(friction_message(FRICTION_OK) == friction_message(FRICTION_OK));
    CHECK(strcmp(friction_version(), EXPECTED_VERSION) == 0);
}

/* Of each size in turn one below zero: a code, from every function, and nothing is touched. A size of zero is one that
 * is too small, or no point at all. */
static void sizes_below_zero_are_told(void)
{
    double statev[8] = {1, -1e-2, 0, 0, 0.3, 0, 0, 0}, traction[3] = {7, 7, 7}, tangent[9], rates[8], du[3] = {0};
    double theta = 1, v = 7, theta_rate, tau = 1, pressure = 1;
    const double before = statev[1], creep[8] = {4, 1, 1, 0.01, 0.015, 1e-2, 1e-6, 0.6};
    int status[1] = {0}, place;

    for (place = 0; place < 4; place++) {
        const int n = place == 0 ? -1 : 1, ndir = place == 1 ? -1 : 3;
        const int nprops = place == 2 ? -1 : 9, nstatv = place == 3 ? -1 : 8;

        CHECK(friction_update_batch(n, ndir, du, 0.1, nprops, props, nstatv, statev, traction, tangent, status)
            == FRICTION_BAD_SIZE);
        CHECK(friction_update_batch_props(n, ndir, du, 0.1, nprops, props, nstatv, statev, traction, tangent, status)
            == FRICTION_BAD_SIZE);
        CHECK(friction_update_points(n, ndir, du, 0.1, nprops, props, nstatv, statev, traction, tangent, status)
            == FRICTION_BAD_SIZE);
        if (place == 0) {
            CHECK(friction_slip_rates(n, &tau, &pressure, 0, 8, creep, &theta, &v, &theta_rate, status)
                == FRICTION_BAD_SIZE);
            CHECK(friction_slip_rates(1, &tau, &pressure, 0, n, creep, &theta, &v, &theta_rate, status)
                == FRICTION_BAD_SIZE);
            continue;
        }
        CHECK(friction_update(ndir, du, 0.1, nprops, props, nstatv, statev, traction, tangent) == FRICTION_BAD_SIZE);
        CHECK(friction_tangential(ndir == 3 ? 2 : -1, du, 1, 0.1, nprops, props, nstatv, statev, traction, tangent, du)
            == FRICTION_BAD_SIZE);
        CHECK(friction_rates(ndir, du, nprops, props, nstatv, statev, rates) == FRICTION_BAD_SIZE);
    }
    CHECK(friction_update_batch(0, 3, du, 0.1, 9, props, 8, statev, traction, tangent, status) == FRICTION_OK);
    CHECK(friction_update_batch_props(0, 3, du, 0.1, 9, props, 8, statev, traction, tangent, status) == FRICTION_OK);
    CHECK(friction_update_points(0, 3, du, 0.1, 9, props, 8, statev, traction, tangent, status) == FRICTION_OK);
    CHECK(friction_slip_rates(0, &tau, &pressure, 0, 8, creep, &theta, &v, &theta_rate, status) == FRICTION_OK);
    CHECK(traction[0] == 7 && traction[1] == 7 && traction[2] == 7 && statev[1] == before && v == 7);
    CHECK(friction_update_batch_props(1, 3, du, 0.1, 9, props, 8, statev, traction, tangent, status) == FRICTION_OK);
}

int main(int argc, char **argv)
{
    if (argc != 2)
        return 2;
    table = argv[1];
    sizes_below_zero_are_told();
    update_slides_on_the_subloading_surface();
    tangential_is_the_same_with_the_pressure_handed_in();
    a_batch_is_component_major();
    a_batch_returns_the_worst_status();
    points_are_in_c_order();
    rates_are_what_the_update_tends_to();
    slip_rates_balance_the_traction();
    every_null_and_every_negative_size_is_told();
    bad_calls_are_codes_and_touch_nothing();
    laws_tell_their_constants();
    broken_rules_are_told();
    texts_are_constant_c_strings();
    printf("%d failures\n", failures);
    return failures != 0;
}
