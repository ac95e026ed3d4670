!> Presses a contact point, slides it forth and back, and prints the friction.
!>
!>     gfortran slide.f90 $(pkg-config --cflags --libs stickslip-fortran) -o slide
!>
!> With the modules of the library, which only the compiler that built it can read. For another
!> compiler, and for the shared library, see slide_any_compiler.f90.
program slide
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use friction_mod, only : friction_message, friction_update, friction_version
    implicit none
    ! law, alpha_n, alpha_t [N/mm^3], mu_s, mu_k [-], kappa [1/mm], xi [1/s], m [1/mm]
    real(dp), parameter :: props(8) = [1.0_dp, 1000.0_dp, 800.0_dp, 0.45_dp, 0.25_dp, 8.0_dp, &
        0.2_dp, 60.0_dp]
    real(dp) :: statev(8), traction(2), tangent(2, 2), du(2)
    integer :: step, status

    statev = 0.0_dp
    print '(2a)', 'stickslip ', friction_version
    print '(a)', ' step   shear [N/mm^2]     mu        R'
    do step = 0, 40
        du = [0.0_dp, merge(0.0005_dp, -0.0005_dp, step <= 20)]
        if (step == 0) du = [-0.002_dp, 0.0_dp]
        call friction_update(du, 0.01_dp, props, statev, traction, tangent, status)
        if (status < 0) error stop friction_message(status)
        print '(i5, f17.9, 2f9.5)', step, traction(2), statev(5:6)
    end do
end program slide
