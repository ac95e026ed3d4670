!> Calls of VFRIC, VFRICTION and VUINTER with the argument lists of Abaqus/Explicit.
module abaqus_explicit_calls
    use, intrinsic :: iso_fortran_env, only : dp => real64
    implicit none
    private

    public :: call_vfric, call_vfriction, call_vuinter

    !> The points of a surface that are in contact, as VFRIC hears of them. In axes that turn from
    !> call to call: the first along the slip.
    type, public :: vfric_contact
        integer :: n = 0                          !! points in contact
        integer, allocatable :: place(:)          !! which of the surface
        real(dp), allocatable :: slip(:, :)       !! increment, (direction, point)
        real(dp), allocatable :: stick_force(:), normal_force(:)
        real(dp), allocatable :: along(:, :)      !! global axes
        real(dp), allocatable :: normal(:, :)     !! global axes
    end type vfric_contact

    character(len=80), parameter :: name = 'CONTACT OF BLOCKS'
    external :: vfric, vfriction, vuinter

contains

    subroutine call_vfric(props, contact, area, dtime, statev, force)
        real(dp), intent(in) :: props(:), area(:), dtime
        type(vfric_contact), intent(in) :: contact
        real(dp), intent(inout) :: statev(:, :)
        real(dp), intent(inout) :: force(:, :)   !! (direction, point in contact)
        real(dp) :: previous(size(contact%slip, 1), size(contact%slip, 2)), zero(1)
        integer :: n_dir, none(1)

        n_dir = size(contact%slip, 1)
        previous = 0.0_dp
        zero = 0.0_dp
        none = 1
        call vfric(force, statev, 1, 1, contact%n, 1, size(statev, 2), 1, n_dir - 1, n_dir, &
            size(statev, 1), size(props), 1, 1, 0, none, none, contact%place, none, 0.0_dp, &
            0.0_dp, dtime, name, name, name, 0, contact%slip, contact%stick_force, previous, &
            contact%normal_force, 0.0_dp, zero, zero, zero, contact%along, contact%normal, props, &
            area, zero, zero, zero, zero)
    end subroutine call_vfric

    !> The same points under general contact, each with a state and an area of its own.
    subroutine call_vfriction(props, contact, area, dtime, state, force)
        real(dp), intent(in) :: props(:), area(:), dtime
        type(vfric_contact), intent(in) :: contact
        real(dp), intent(inout) :: state(:, :, :)   !! (variable, 1 or 4 for edges, point)
        real(dp), intent(inout) :: force(:, :)      !! (direction, point)
        real(dp) :: zero(1), times(4)
        integer :: node(1, size(area)), flags(3), n_dir, none(1)

        n_dir = size(contact%slip, 1)
        zero = 0.0_dp
        none = 1
        node = 7
        flags = [1, 1, 0]
        times = [0.0_dp, 0.0_dp, dtime, 0.0_dp]
        call vfriction(force, state, contact%n, contact%n, 1, size(state, 2), 1, 4, n_dir - 1, &
            n_dir, size(state, 1), size(props), 1, 1, flags, times, name, name, name, node, none, &
            props, contact%slip, contact%stick_force, zero, contact%normal_force, area, &
            contact%normal, contact%along, zero, zero, zero, zero, zero, zero, zero, zero, zero, &
            zero)
    end subroutine call_vfriction

    subroutine call_vuinter(props, rdisp, drdisp, dtime, drot, statev, stress, sed, dissipated)
        real(dp), intent(in) :: props(:), rdisp(:, :), drdisp(:, :), dtime, drot(:, :, :)
        real(dp), intent(inout) :: statev(:, :), stress(:, :), sed(:)
        real(dp), intent(inout) :: dissipated(:, :)   !! (point, kind): SFD, SCD, SPD, SVD
        real(dp) :: zero(1)
        integer :: uid(size(rdisp, 2)), i

        zero = 0.0_dp
        uid = [(100 + i, i = 1, size(uid))]
        call vuinter(dissipated(:, 1), dissipated(:, 2), dissipated(:, 3), dissipated(:, 4), &
            stress, zero, zero, sed, statev, 1, 1, 1, size(rdisp, 2), 1, 1, size(rdisp, 1), &
            size(statev, 1), size(props), 1, 1, 0, uid, uid, uid, 0.0_dp, 0.0_dp, dtime, name, &
            name, name, rdisp, drdisp, drot, 0.0_dp, 0.0_dp, zero, zero, zero, zero, props, zero, &
            zero, zero, zero, zero, zero, zero, zero, zero)
    end subroutine call_vuinter

end module abaqus_explicit_calls
