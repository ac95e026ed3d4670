!> The same as slide.f90 through the C functions, with any Fortran compiler:
!>
!>     FC $(pkg-config --variable=interface stickslip) slide_any_compiler.f90 \
!>         $(pkg-config --libs stickslip) -o slide
program slide_any_compiler
    use, intrinsic :: iso_c_binding, only : c_double, c_int
    use friction_interface, only : friction_message, friction_text, friction_update, &
        friction_version
    implicit none
    ! law, alpha_n, alpha_t [N/mm^3], mu_s, mu_k [-], kappa [1/mm], xi [1/s], m [1/mm]
    real(c_double), parameter :: props(8) = [1.0_c_double, 1000.0_c_double, 800.0_c_double, &
        0.45_c_double, 0.25_c_double, 8.0_c_double, 0.2_c_double, 60.0_c_double]
    real(c_double), parameter :: dt = 0.01_c_double
    real(c_double) :: statev(8), traction(2), tangent(2, 2), du(2)
    integer :: step
    integer(c_int) :: status

    statev = 0.0_c_double
    print '(2a)', 'stickslip ', friction_text(friction_version())
    print '(a)', ' step   shear [N/mm^2]     mu        R'
    do step = 0, 40
        du = [0.0_c_double, merge(0.0005_c_double, -0.0005_c_double, step <= 20)]
        if (step == 0) du = [-0.002_c_double, 0.0_c_double]
        status = friction_update(2, du, dt, 8, props, 8, statev, traction, tangent)
        if (status < 0) then
            print '(a)', friction_text(friction_message(status))
            error stop
        end if
        print '(i5, f17.9, 2f9.5)', step, traction(2), statev(5:6)
    end do
end program slide_any_compiler
