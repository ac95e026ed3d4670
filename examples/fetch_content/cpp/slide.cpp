// Presses a contact point, slides it forth and back, and prints the friction.
#include <array>
#include <cstdio>
#include <friction.h>

int main()
{
    // law, alpha_n, alpha_t [N/mm^3], mu_s, mu_k [-], kappa [1/mm], xi [1/s], m [1/mm]
    const std::array<double, 8> props{1, 1000, 800, 0.45, 0.25, 8, 0.2, 60};
    std::array<double, 8> statev{};
    std::array<double, 2> traction{};
    std::array<double, 4> tangent{};
    const double dt = 0.01;

    std::printf("stickslip %s\n step   shear [N/mm^2]     mu        R\n", friction_version());
    for (int step = 0; step <= 40; ++step) {
        const std::array<double, 2> du{step == 0 ? -0.002 : 0.0, step == 0 ? 0.0 : step <= 20 ? 0.0005 : -0.0005};
        const int status = friction_update(2, du.data(), dt, 8, props.data(), 8, statev.data(), traction.data(),
                                           tangent.data());
        if (status < 0) {
            std::fprintf(stderr, "%s\n", friction_message(status));
            return 1;
        }
        std::printf("%5d %16.9f %8.5f %8.5f\n", step, traction[1], statev[4], statev[5]);
    }
}
