!> How far the results of two routines lie apart, and what neither may ever do.
module agreement
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use contact_sets, only : contact_set, props
    use friction_mod, only : friction_update, statev_mu, statev_r, statev_slip, statev_u_et
    use worst_errors, only : worse, worst_of
    implicit none
    private

    public :: batch_results, compare_batch, compare_point, deviation, merge_deviations, &
        point_results

    !> Results of a point.
    type :: point_results
        real(dp) :: statev(8), traction(3), tangent(3, 3)
        integer :: status
    end type point_results

    !> Results of many points, component-major.
    type :: batch_results
        real(dp), allocatable :: statev(:, :), traction(:, :), tangent(:, :, :)
        integer, allocatable :: status(:)
    end type batch_results

    !> The worst that was seen.
    type :: deviation
        real(dp) :: traction = 0.0_dp   !! difference by the pressure [-]
        real(dp) :: state = 0.0_dp      !! difference by the natural scale of each variable [-]
        real(dp) :: tangent = 0.0_dp    !! difference by the stiffness [-]
        real(dp) :: slip = 0.0_dp       !! difference of the slip by the path [-]
        integer :: failures = 0         !! points with a negative status, in either routine
        integer :: backward = 0         !! points that slid by less than nothing, in either
    end type deviation

contains

    !> Compares what the batch routine made of a set with the scalar routine.
    subroutine compare_batch(set, dt, batch, apart)
        type(contact_set), intent(in) :: set
        real(dp), intent(in) :: dt                 !! [T]
        type(batch_results), intent(in) :: batch
        type(deviation), intent(inout) :: apart    !! the worst until now, updated
        type(point_results) :: one, other
        real(dp) :: du(3), before(8)
        integer :: k, increment

        do k = 1, size(set%du, 1)
            du = set%du(k, :)
            before = set%statev(k, :)
            one%statev = before
            do increment = 1, set%increments
                call friction_update(du, dt, props, one%statev, one%traction, one%tangent, &
                    one%status)
            end do
            other%statev = batch%statev(k, :)
            other%traction = batch%traction(k, :)
            other%tangent = batch%tangent(k, :, :)
            other%status = batch%status(k)
            call compare_point(before, set%increments * norm2(du), one, other, apart)
        end do
    end subroutine compare_batch

    !> Compares the results of a point from two routines.
    pure subroutine compare_point(before, path, one, other, apart)
        real(dp), intent(in) :: before(8)            !! state at the start
        real(dp), intent(in) :: path                 !! length of the displacement since then [L]
        type(point_results), intent(in) :: one       !! gives the scales
        type(point_results), intent(in) :: other
        type(deviation), intent(inout) :: apart      !! the worst until now, updated
        real(dp) :: pressure, reach, trial, scale(8)

        if (min(one%status, other%status) < 0) apart%failures = apart%failures + 1
        if (min(one%statev(statev_slip), other%statev(statev_slip)) < before(statev_slip)) then
            apart%backward = apart%backward + 1
        end if

        ! Slip is what the trial elastic displacement loses: the scale of both is its length.
        pressure = -one%traction(1)
        reach = pressure / props(3)
        trial = norm2(before(statev_u_et:statev_u_et + 1)) + path
        scale = [1.0_dp, pressure / props(2), reach, reach, one%statev(statev_mu), &
            one%statev(statev_r), trial, props(4) * pressure * trial]
        apart%traction = worse(apart%traction, worst_of(abs(other%traction - one%traction)) &
            / pressure)
        apart%state = worse(apart%state, worst_of(abs(other%statev - one%statev) / scale))
        apart%slip = worse(apart%slip, abs(other%statev(statev_slip) - one%statev(statev_slip)) &
            / path)
        apart%tangent = worse(apart%tangent, worst_of(abs(other%tangent - one%tangent)) &
            / props(3))
    end subroutine compare_point

    pure function merge_deviations(a, b) result(both)
        type(deviation), intent(in) :: a
        type(deviation), intent(in) :: b
        type(deviation) :: both

        both = deviation(worse(a%traction, b%traction), worse(a%state, b%state), &
            worse(a%tangent, b%tangent), worse(a%slip, b%slip), a%failures + b%failures, &
            a%backward + b%backward)
    end function merge_deviations

end module agreement
