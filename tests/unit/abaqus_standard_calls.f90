!> Calls of FRIC, UINTER and UMAT with the argument lists of Abaqus/Standard.
module abaqus_standard_calls
    use, intrinsic :: iso_fortran_env, only : dp => real64
    implicit none
    private

    public :: call_fric, call_uinter, call_umat

    !> What FRIC gives beside TAU and STATEV, for one or two directions.
    type, public :: fric_answer
        real(dp) :: by_du(2, 2) = 0.0_dp, by_p(2) = 0.0_dp   !! derivatives of TAU
        real(dp) :: by_temperature(2, 2) = 0.0_dp
        real(dp) :: dslip(2) = 0.0_dp
        real(dp) :: sed = 0.0_dp, sfd = 0.0_dp
        real(dp) :: pnewdt = 1.0_dp
        integer :: lm = 0
    end type fric_answer

    !> What UINTER gives beside STRESS, DDSDDR and STATEV.
    type, public :: uinter_answer
        real(dp) :: sed = 0.0_dp
        real(dp) :: dissipated(4) = -7.0_dp   !! SFD, SPD, SVD, SCD: to be defined
        real(dp) :: pnewdt = 1.0_dp
        integer :: openclose = -1, state = -1, severe = 0
    end type uinter_answer

    !> What UMAT gives beside STRESS, DDSDDE and STATEV.
    type, public :: umat_answer
        real(dp) :: sse = 0.0_dp, spd = 0.0_dp, pnewdt = 1.0_dp
    end type umat_answer

    integer, public :: n_statev = 8   !! how many state variables the host says that there are

    character(len=80), parameter :: name = 'CONTACT OF BLOCKS'
    external :: fric, uinter, umat

contains

    subroutine call_fric(props, dgam, press, dtime, drot, statev, tau, answer)
        real(dp), intent(in) :: props(:), dgam(:), press, dtime, drot(2, 2)
        real(dp), intent(inout) :: statev(8), tau(:)
        type(fric_answer), intent(inout) :: answer
        real(dp) :: zero(6)
        integer :: n

        zero = 0.0_dp
        n = size(dgam)
        call fric(answer%lm, tau, answer%by_du(1:n, 1:n), answer%by_p, answer%dslip, answer%sed, &
            answer%sfd, answer%by_temperature(1:n, :), answer%pnewdt, statev, dgam, zero, press, &
            0.0_dp, 0.0_dp, zero, 1, 1, zero, dtime, 1, name, name, name, 1, 1, 1, zero, zero, &
            drot, zero, zero, n, 3, 1, n_statev, 1.0_dp, props, size(props))
    end subroutine call_fric

    subroutine call_uinter(props, rdisp, drdisp, dtime, drot, statev, stress, stiffness, answer, &
        perturbation)
        real(dp), intent(in) :: props(:), rdisp(:), drdisp(:), dtime, drot(2, 2)
        real(dp), intent(inout) :: statev(8), stress(:), stiffness(:, :)
        type(uinter_answer), intent(inout) :: answer
        logical, intent(in), optional :: perturbation
        integer :: linear
        real(dp) :: zero(9)

        zero = 0.0_dp
        answer%severe = 0
        linear = 0
        if (present(perturbation)) linear = merge(1, 0, perturbation)
        call uinter(stress, stiffness, zero, zero, zero, zero, zero, zero, statev, answer%sed, &
            answer%dissipated(1), answer%dissipated(2), answer%dissipated(3), &
            answer%dissipated(4), answer%pnewdt, rdisp, drdisp, zero, zero, zero, zero, zero, &
            dtime, 0.0_dp, name, name, name, props, zero, zero, drot, 1.0_dp, 0.5_dp, 1, &
            size(rdisp), n_statev, 1, size(props), 3, 1, 1, 1, linear, answer%openclose, &
            answer%state, answer%severe, 0)
    end subroutine call_uinter

    subroutine call_umat(ndi, nshr, props, dstran, dtime, drot, statev, stress, ddsdde, answer, &
        deformation, perturbation)
        integer, intent(in) :: ndi, nshr
        real(dp), intent(in) :: props(:), dstran(:), dtime, drot(3, 3)
        real(dp), intent(inout) :: statev(8), stress(:), ddsdde(:, :)
        type(umat_answer), intent(inout) :: answer
        real(dp), intent(in), optional :: deformation(3, 3)   !! gradient at the end, under NLGEOM
        logical, intent(in), optional :: perturbation
        real(dp) :: gradient(3, 3), zero(36), scd, rpl
        integer :: step(4)

        zero = 0.0_dp
        step = [1, 1, 0, 0]
        gradient = 0.0_dp
        if (present(perturbation)) step(4) = merge(1, 0, perturbation)
        if (present(deformation)) then
            step(3) = 1
            gradient = deformation
        end if
        call umat(stress, statev, ddsdde, answer%sse, answer%spd, scd, rpl, zero, zero, zero, &
            zero, dstran, zero, dtime, 0.0_dp, 0.0_dp, zero, zero, name, ndi, nshr, ndi + nshr, &
            n_statev, props, size(props), zero, drot, answer%pnewdt, 1.0_dp, zero, gradient, 1, 1, &
            1, 1, step, 1)
    end subroutine call_umat

end module abaqus_standard_calls
