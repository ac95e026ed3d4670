/* Presses a contact point, slides it forth and back, and prints the friction.
 *
 *     cc slide.c $(pkg-config --cflags --libs stickslip) -o slide */
#include <friction.h>
#include <stdio.h>

int main(void)
{
    /* law, alpha_n, alpha_t [N/mm^3], mu_s, mu_k [-], kappa [1/mm], xi [1/s], m [1/mm] */
    const double props[] = {1, 1000, 800, 0.45, 0.25, 8, 0.2, 60};
    double statev[8] = {0}, traction[2], tangent[4];
    const double dt = 0.01;

    printf("stickslip %s\n step   shear [N/mm^2]     mu        R\n", friction_version());
    for (int step = 0; step <= 40; step++) {
        double du[2] = {step == 0 ? -0.002 : 0.0, step == 0 ? 0.0 : step <= 20 ? 0.0005 : -0.0005};
        int status = friction_update(2, du, dt, 8, props, 8, statev, traction, tangent);
        if (status < 0) {
            fprintf(stderr, "%s\n", friction_message(status));
            return 1;
        }
        printf("%5d %16.9f %8.5f %8.5f\n", step, traction[1], statev[4], statev[5]);
    }
    return 0;
}
