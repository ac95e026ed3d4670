// Presses a contact point, slides it forth and back, and prints the friction: through MGIS, as any MFront behaviour.
//
//     c++ -std=c++20 slide.cpp -lMFrontGenericInterface -o slide && ./slide libstickslip_mgis.so
#include <cstdio>
#include <MGIS/Behaviour/Behaviour.hxx>
#include <MGIS/Behaviour/BehaviourData.hxx>
#include <MGIS/Behaviour/Integrate.hxx>
#include <MGIS/Behaviour/State.hxx>

int main(int argc, char **argv)
{
    using namespace mgis::behaviour;
    if (argc < 2)
        return 2;
    const Behaviour behaviour = load(argv[1], "StickSlipSubloading", Hypothesis::PLANESTRAIN);
    BehaviourData data{behaviour};
    const struct {
        const char *name;
        double value;
    } constants[] = {{"NormalStiffness", 1000}, {"TangentialStiffness", 800}, {"StaticFriction", 0.45},
                     {"KineticFriction", 0.25}, {"AdhesionBreakingExponent", 8}, {"AdhesionFormingExponent", 0.2},
                     {"SubloadingExponent", 60}};
    for (const auto &constant : constants)
        setMaterialProperty(data.s1, constant.name, constant.value);
    update(data);
    data.dt = 0.01;
    std::printf(" step   shear [N/mm^2]     mu        R\n");
    for (int step = 0; step <= 40; ++step) {
        data.s1.gradients[0] = -0.002;
        data.s1.gradients[1] += step == 0 ? 0.0 : step <= 20 ? 0.0005 : -0.0005;
        data.K[0] = 4;   // integrate, and give the consistent tangent operator
        data.rdt = 1;
        auto view = make_view(data);
        if (integrate(view, behaviour) != 1) {
            std::fprintf(stderr, "%s\n", data.error_message);
            return 1;
        }
        update(data);
        std::printf("%5d %16.9f %8.5f %8.5f\n", step, data.s1.thermodynamic_forces[1],
                    data.s1.internal_state_variables[4], data.s1.internal_state_variables[5]);
    }
}
