/* MFront's generic interface: what a host's loader (MGIS) reads in libstickslip_mgis.so, and the update.
 *
 * Two behaviours a law: StickSlip<Law>, a cohesive zone (OpeningDisplacement to CohesiveForce), and
 * StickSlip<Law>Layer, a thin layer of solid elements (Strain to Stress); and the same with the ending WithOptions,
 * which take the constants that may be left out, too. The constants are material properties, the state is in
 * internal state variables (docs/hosts.md). */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include <friction.h>

/* The structures that a host hands in; their layout is MFront's. */
typedef struct {
    const double *gradients, *thermodynamic_forces, *mass_density, *material_properties, *internal_state_variables,
        *stored_energy, *dissipated_energy, *external_state_variables;
} initial_state;

typedef struct {
    const double *gradients;
    double *thermodynamic_forces;
    const double *mass_density, *material_properties;
    double *internal_state_variables, *stored_energy, *dissipated_energy;
    const double *external_state_variables;
} final_state;

typedef struct {
    char *error_message;   /* room for 512 characters, or NULL */
    double dt;             /* increment of time [T] */
    double *K;             /* in: what is asked for; out: the operator, row by row */
    double *rdt;           /* in: largest factor on the next dt; out: the factor proposed */
    double *speed_of_sound;
    initial_state s0;      /* at the start of the increment */
    final_state s1;        /* at its end */
} behaviour_data;

/* Bounds of numbers, those of friction.h's constants. */
static const double least = 0x1p-333, largest = 0x1p333;

enum { failed = -1, unreliable = 0, reliable = 1, message_size = 512, most_props = 32 };

/* Which stresses and strains of an element are the contact's, in MFront's order (xx yy zz xy xz yz, shear
 * times the square root of two). A cohesive zone has its components in the order of friction.h. */
typedef struct {
    int contact;    /* components of the contact: normal, tangential */
    int size;       /* components of the gradient */
    int place[3];   /* of the contact's components in the gradient */
    int layer;      /* a layer of solid elements: thickness and modulus come before the constants */
} geometry;

static const geometry zone_in_plane = {2, 2, {0, 1, 0}, 0};
static const geometry zone_in_space = {3, 3, {0, 1, 2}, 0};
static const geometry layer_in_plane = {2, 4, {1, 3, 0}, 1};      /* normal to y (z of axial symmetry) */
static const geometry layer_in_space = {3, 6, {2, 4, 5}, 1};      /* normal to z */

static int fail(const behaviour_data *data, int status, const char *cause)
{
    if (data->error_message)
        snprintf(data->error_message, message_size, "stickslip, code %d: %s%s%s", status, friction_message(status),
                 *cause ? ": " : "", cause);
    if (data->rdt && *data->rdt > 0.1)
        *data->rdt = 0.1;
    return failed;
}

/* A number in range? Compared so that a NaN raises no exception in the host. */
static int is_usable(double x)
{
    return isless(fabs(x), largest);
}

/* Gap or strain to displacement, traction to stress: 1 for a normal component of a layer and for all of a zone. */
static double factor(const geometry *form, int i)
{
    return form->layer && i > 0 ? sqrt(2.0) : 1.0;
}

static void elastic_tangent(const geometry *form, const double *props, double *tangent)
{
    int i;

    memset(tangent, 0, 9 * sizeof *tangent);
    for (i = 0; i < form->contact; i++)
        tangent[i * (form->contact + 1)] = i == 0 ? props[1] : props[2];
}

/* A host that asks for the forces as they stand, with neither time nor motion, gets them also under a law of the
 * slip rate or with a damper: in an instant nothing happens, and the contact is elastic. */
static int update(const double *du, double dt, const geometry *form, int nprops, const double *props, double *statev,
                  double *traction, double *tangent)
{
    const double instant = 1e-200;
    int status = friction_update(form->contact, du, dt, nprops, props, 8, statev, traction, tangent), i;

    for (i = 0; status == FRICTION_ZERO_TIME_INCREMENT && i < form->contact; i++)
        if (du[i] != 0)
            return status;
    if (status == FRICTION_ZERO_TIME_INCREMENT) {
        status = friction_update(form->contact, du, instant, nprops, props, 8, statev, traction, tangent);
        if (status >= 0) {
            elastic_tangent(form, props, tangent);
            status = FRICTION_OK;   /* where nothing moves, no other equilibrium is within reach */
        }
    }
    return status;
}

/* The host's operator, from the contact's (column by column). In its plane a layer is elastic without
 * contracting sideways. */
static void put_operator(const geometry *form, double thickness, double modulus, const double *tangent, double *K)
{
    int i, j;

    memset(K, 0, (size_t)(form->size * form->size) * sizeof *K);
    for (i = 0; i < form->size; i++)
        K[i * form->size + i] = modulus;
    for (i = 0; i < form->contact; i++)
        for (j = 0; j < form->contact; j++)
            K[form->place[i] * form->size + form->place[j]] =
                factor(form, i) * factor(form, j) * thickness * tangent[j * form->contact + i];
}

static double squares(const double *x, int n)
{
    double sum = 0;

    while (n-- > 0)
        sum += x[n] * x[n];
    return sum;
}

/* Twice the elastic energy in the plane of a layer, over its modulus. */
static double in_plane_strain(const geometry *form, const double *strain)
{
    double sum = 0;
    int i, j;

    for (i = 0, j = 0; i < form->size; i++)
        if (j < form->contact && i == form->place[j])
            j++;   /* places are in ascending order */
        else
            sum += strain[i] * strain[i];
    return sum;
}

static void put_results(const behaviour_data *data, const geometry *form, double thickness, double modulus,
                        const double *props, const double *statev, const double *traction)
{
    const final_state *end = &data->s1;
    double penetration = statev[1] < 0 ? statev[1] : 0;
    double stored = 0.5 * (props[1] * penetration * penetration + props[2] * squares(statev + 2, 2)) / thickness;
    int i;

    for (i = 0; form->layer && i < form->size; i++)
        end->thermodynamic_forces[i] = modulus * end->gradients[i];
    for (i = 0; i < form->contact; i++)
        end->thermodynamic_forces[form->place[i]] = factor(form, i) * traction[i];
    memcpy(end->internal_state_variables, statev, 8 * sizeof *statev);
    if (form->layer)
        stored += 0.5 * modulus * in_plane_strain(form, end->gradients);
    if (end->stored_energy)
        *end->stored_energy = stored;
    if (end->dissipated_energy)
        *end->dissipated_energy = statev[7] / thickness;
}

/* Neither a gap nor a pressure, and nothing moves yet. The stiffness then is that of the springs: with that of a gap,
 * which is none, a host could not press two bodies by a force. */
static int just_touches(const geometry *form, const double *du, const double *statev)
{
    const double point_open = 3;
    int i;

    for (i = 0; i < form->contact; i++)
        if (du[i] != 0)
            return 0;
    return statev[0] == point_open && statev[1] == 0;
}

/* What the host asks for, in K[0]. */
typedef struct {
    int integrate, operator_wanted, elastic, sound;
} request;

static request read_request(double code)
{
    request asked;

    asked.sound = code > 50;
    if (asked.sound)
        code -= 100;
    asked.integrate = code > -0.25;
    asked.operator_wanted = !asked.integrate || code > 0.5;
    asked.elastic = asked.integrate ? code < 2.5 : code > -2.5;
    return asked;
}

/* One integration point: `own` constants of law number `law` follow the two stiffnesses. */
static int integrate(behaviour_data *data, int law, int own, const geometry *form)
{
    const double *properties = data->s1.material_properties;
    const request asked = read_request(data->K[0]);
    double thickness = 1, modulus = 0, props[most_props], statev[8], du[3], traction[3], tangent[9];
    int status, i;

    if (form->layer) {
        thickness = properties[0];
        modulus = properties[1];
        properties += 2;
        if (!(isgreaterequal(thickness, least) && isless(thickness, largest)
              && (modulus == 0 || isgreaterequal(modulus, least)) && isless(modulus, largest)))
            return fail(data, FRICTION_BAD_PROPERTY, "Thickness must be > 0, InPlaneModulus >= 0");
    }
    for (i = 0; asked.integrate && i < form->size; i++)
        if (!(is_usable(data->s1.gradients[i]) && is_usable(modulus * data->s1.gradients[i])))
            return fail(data, FRICTION_BAD_INCREMENT, "");
    props[0] = law;
    memcpy(props + 1, properties, (size_t)(own + 2) * sizeof *props);
    memcpy(statev, data->s0.internal_state_variables, sizeof statev);
    for (i = 0; i < form->contact; i++) {
        const double *start = &data->s0.gradients[form->place[i]], *end = &data->s1.gradients[form->place[i]];

        if (asked.integrate && !is_usable(*start))
            return fail(data, FRICTION_BAD_INCREMENT, "");
        du[i] = asked.integrate ? thickness * factor(form, i) * (*end - *start) : 0;
    }
    status = update(du, asked.integrate ? data->dt : 0, form, own + 3, props, statev, traction, tangent);
    if (status < 0) {
        char cause[97] = "";   /* which constant breaks which rule */

        friction_check(own + 3, props, sizeof cause, cause);
        return fail(data, status, cause);
    }
    if (asked.elastic || just_touches(form, du, statev))
        elastic_tangent(form, props, tangent);
    if (asked.operator_wanted)
        put_operator(form, thickness, modulus, tangent, data->K);
    if (asked.sound && data->speed_of_sound)
        *data->speed_of_sound = form->layer ? sqrt(thickness * fmax(props[1], props[2]) / *data->s1.mass_density) : 0;
    if (!asked.integrate)
        return reliable;
    put_results(data, form, thickness, modulus, props, statev, traction);
    if (status == FRICTION_SNAP_BACK) {
        if (data->rdt && *data->rdt > 0.5)
            *data->rdt = 0.5;
        return unreliable;
    }
    return reliable;
}

/* The symbols. A loader takes the address of a variable and reads the variable there, also of a text. */
typedef unsigned short us;
typedef const char *const text;

#define TEXT(B, name, value) extern text B##_##name; text B##_##name = value;
#define NUMBER(B, name, value) extern const us B##_##name; const us B##_##name = value;
#define LIST(B, what, count, ...) \
    NUMBER(B, n##what, count) \
    extern text B##_##what[]; text B##_##what[] = {__VA_ARGS__};
#define TYPES(B, what, ...) extern const int B##_##what##Types[]; const int B##_##what##Types[] = {__VA_ARGS__};
#define NONE(B, what) \
    NUMBER(B, n##what, 0) \
    extern text *const B##_##what; text *const B##_##what = 0;
#define NONE_TYPED(B, what) \
    NONE(B, what) \
    extern const int *const B##_##what##Types; const int *const B##_##what##Types = 0;

#define BEHAVIOUR(B, type, kinematic, gradient, force, code) \
    TEXT(B, mfront_ept, #B) TEXT(B, mfront_interface, "Generic") TEXT(B, tfel_version, "4.2.0") \
    TEXT(B, unit_system, "") TEXT(B, src, "stickslip") TEXT(B, author, "") TEXT(B, date, "") \
    TEXT(B, validator, "") TEXT(B, build_id, "") \
    NUMBER(B, mfront_mkt, 1) NUMBER(B, api_version, 1) \
    NUMBER(B, BehaviourType, type) NUMBER(B, BehaviourKinematic, kinematic) \
    NUMBER(B, SymmetryType, 0) NUMBER(B, ElasticSymmetryType, 0) \
    NUMBER(B, TemperatureRemovedFromExternalStateVariables, 0) \
    NUMBER(B, requiresStiffnessTensor, 0) NUMBER(B, requiresThermalExpansionCoefficientTensor, 0) \
    NUMBER(B, ComputesInternalEnergy, 1) NUMBER(B, ComputesDissipatedEnergy, 1) \
    NUMBER(B, UsableInPurelyImplicitResolution, 0) \
    LIST(B, Gradients, 1, gradient) TYPES(B, Gradients, code) \
    LIST(B, ThermodynamicForces, 1, force) TYPES(B, ThermodynamicForces, code) \
    LIST(B, TangentOperatorBlocks, 2, force, gradient) \
    LIST(B, InternalStateVariables, 8, "Status", "NormalGap", "ElasticShear1", "ElasticShear2", \
         "FrictionCoefficient", "Internal", "Slip", "DissipatedEnergy") \
    TYPES(B, InternalStateVariables, 0, 0, 0, 0, 0, 0, 0, 0) \
    NONE_TYPED(B, ExternalStateVariables) NONE_TYPED(B, Parameters) \
    NONE(B, InitializeFunctions) NONE(B, PostProcessings)

#define ENTRY(B, hypothesis, law, own, form) \
    int B##_##hypothesis(behaviour_data *data); \
    int B##_##hypothesis(behaviour_data *data) \
    { \
        _Static_assert(own + 3 <= most_props, "room for the constants"); \
        return integrate(data, law, own, &form); \
    }

#define ZONE(B, law, own, ...) \
    BEHAVIOUR(B, 3, 2, "OpeningDisplacement", "CohesiveForce", 2) \
    LIST(B, MaterialProperties, own + 2, "NormalStiffness", "TangentialStiffness", __VA_ARGS__) \
    LIST(B, ModellingHypotheses, 5, "Axisymmetrical", "PlaneStress", "PlaneStrain", "GeneralisedPlaneStrain", \
         "Tridimensional") \
    ENTRY(B, Axisymmetrical, law, own, zone_in_plane) \
    ENTRY(B, PlaneStress, law, own, zone_in_plane) \
    ENTRY(B, PlaneStrain, law, own, zone_in_plane) \
    ENTRY(B, GeneralisedPlaneStrain, law, own, zone_in_plane) \
    ENTRY(B, Tridimensional, law, own, zone_in_space)

#define LAYER(B, law, own, ...) \
    BEHAVIOUR(B, 1, 1, "Strain", "Stress", 1) \
    LIST(B, MaterialProperties, own + 4, "Thickness", "InPlaneModulus", "NormalStiffness", "TangentialStiffness", \
         __VA_ARGS__) \
    LIST(B, ModellingHypotheses, 4, "Axisymmetrical", "PlaneStrain", "GeneralisedPlaneStrain", "Tridimensional") \
    ENTRY(B, Axisymmetrical, law, own, layer_in_plane) \
    ENTRY(B, PlaneStrain, law, own, layer_in_plane) \
    ENTRY(B, GeneralisedPlaneStrain, law, own, layer_in_plane) \
    ENTRY(B, Tridimensional, law, own, layer_in_space)

#define PAIR(zone, layer, law, own, ...) \
    ZONE(zone, law, own, __VA_ARGS__) \
    LAYER(layer, law, own, __VA_ARGS__)
#define BEHAVIOURS(B, ending, law, own, ...) PAIR(B##ending, B##Layer##ending, law, own, __VA_ARGS__)

/* Made from the library's tables by cmake/mgis_behaviours.f90; fpm, which builds the library alone, has none. */
#if __has_include("mgis_behaviours.h")
#include "mgis_behaviours.h"
#endif
