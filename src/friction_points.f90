!> Many contact points, each point's numbers side by side (public name and arguments: module
!> friction_mod). Blocks of points are transposed, in cache, around the batch routine.
submodule(friction_mod:friction_batch) friction_points
    use friction_lane_block, only : apart
    use friction_threads, only : worth_threads
    implicit none

    !> The block's columns: first ones of each array.
    integer, parameter :: at_du = 1, at_statev = at_du + 3, at_traction = at_statev + statev_size, &
        at_tangent = at_traction + 3, columns = at_tangent + 8

    interface
        !> See module friction_points_kernel.
        subroutine points_kernel_in(du, statev, du_block, statev_block) &
            bind(C, name='stickslip_points_kernel_in')
            import :: apart, c_double, lanes
            implicit none
            real(c_double), intent(in) :: du(3, lanes), statev(8, lanes)
            real(c_double), intent(inout) :: du_block(apart, 3), statev_block(apart, 8)
        end subroutine points_kernel_in

        subroutine points_kernel_out(statev_block, traction_block, tangent_block, statev, &
            traction, tangent) bind(C, name='stickslip_points_kernel_out')
            import :: apart, c_double, lanes
            implicit none
            real(c_double), intent(in) :: statev_block(apart, 8), traction_block(apart, 3)
            real(c_double), intent(in) :: tangent_block(apart, 3, 3)
            real(c_double), intent(inout) :: statev(8, lanes), traction(3, lanes)
            real(c_double), intent(inout) :: tangent(3, 3, lanes)
        end subroutine points_kernel_out
    end interface

contains

    module subroutine friction_update_points(du, dtime, props, statev, traction, tangent, status)
        real(wp), intent(in), contiguous :: du(:, :), props(:)
        real(wp), intent(in) :: dtime
        real(wp), intent(inout), contiguous :: statev(:, :), traction(:, :), tangent(:, :, :)
        integer, intent(out), contiguous :: status(:)
        integer(int64) :: n
        integer :: ndir

        ndir = size(du, 1)
        n = size(du, 2, int64)
        status = friction_bad_size
        if (size(statev, 2, int64) /= n .or. size(traction, 2, int64) /= n &
            .or. size(tangent, 3, int64) /= n .or. size(status, 1, int64) /= n) return
        if (size(traction, 1) /= ndir .or. size(tangent, 1) /= ndir &
            .or. size(tangent, 2) /= ndir) return
        call update_arrays_points(array_sizes(n, ndir, size(props), size(statev, 1)), du, dtime, &
            props, statev, traction, tangent, status)
    end subroutine friction_update_points

    module subroutine update_arrays_points(sizes, du, dtime, props, statev, traction, tangent, &
        status)
        type(array_sizes), intent(in) :: sizes
        real(wp), intent(in) :: du(sizes%ndir, sizes%points), dtime, props(sizes%nprops)
        real(wp), intent(inout) :: statev(sizes%nstatv, sizes%points)
        real(wp), intent(inout) :: traction(sizes%ndir, sizes%points)
        real(wp), intent(inout) :: tangent(sizes%ndir, sizes%ndir, sizes%points)
        integer, intent(out) :: status(sizes%points)
        type(batch) :: this   ! of one block
        real(wp), target :: constants(columns_room)
        integer(int64) :: number, last_block

        if (sizes%points == 0) return
        if (sizes%ndir < 2 .or. sizes%ndir > 3 .or. sizes%nstatv < statev_size) then
            status = friction_bad_size
            return
        end if
        call prepare(this, constants, array_sizes(int(apart, int64), sizes%ndir, sizes%nprops, &
            statev_size), dtime, 1_int64, props)
        last_block = (sizes%points + lanes - 1) / lanes
        if (.not. worth_threads(sizes%points, few)) then
            do number = 1, last_block
                call update_block(number)
            end do
        else
            !$omp parallel do schedule(static)
            do number = 1, last_block
                call update_block(number)
            end do
            !$omp end parallel do
        end if

    contains

        subroutine update_block(number)
            integer(int64), intent(in) :: number
            real(wp), target :: room(apart * columns + line)
            integer(int64) :: first
            integer :: count, start

            first = (number - 1) * lanes + 1
            count = int(min(int(lanes, int64), sizes%points - first + 1))
            start = line_start(room)
            call update_transposed(this, count, room(start), du(1, first), props, &
                sizes%nstatv, statev(1, first), traction(1, first), tangent(1, 1, first), &
                status(first))
        end subroutine update_block

    end subroutine update_arrays_points

    !> One block.
    subroutine update_transposed(this, count, block, du, props, nstatv, statev, traction, tangent, &
        status)
        type(batch), intent(in) :: this
        integer, intent(in) :: count    !! points of this block, `lanes` at most
        real(wp), intent(inout) :: block(apart, columns)   !! workspace
        integer, intent(in) :: nstatv   !! numbers from one point's state to the next's
        real(wp), intent(in) :: du(this%ndir, count), props(this%nprops)
        real(wp), intent(inout) :: statev(nstatv, count), traction(this%ndir, count)
        real(wp), intent(inout) :: tangent(this%ndir, this%ndir, count)
        integer, intent(inout) :: status(count)

        logical :: whole   ! a block in space, for the kernel

        whole = this%ndir == 3 .and. count == lanes .and. nstatv == statev_size
        ! Loops whose lengths the compiler knows take less time.
        if (whole) then
            call points_kernel_in(du, statev, block(1, at_du), block(1, at_statev))
        else if (this%ndir == 3) then
            call to_lanes(3, count, nstatv, du, statev, block)
        else
            call to_lanes(2, count, nstatv, du, statev, block)
        end if
        call update_range(this, 1_int64, int(count, int64), block(1, at_du), props, &
            block(1, at_statev), block(1, at_traction), block(1, at_tangent), status)
        if (whole) whole = all(status >= 0)
        if (whole) then
            call points_kernel_out(block(1, at_statev), block(1, at_traction), &
                block(1, at_tangent), statev, traction, tangent)
        else if (this%ndir == 3) then
            call to_points(3, count, nstatv, status, block, statev, traction, tangent)
        else
            call to_points(2, count, nstatv, status, block, statev, traction, tangent)
        end if
    end subroutine update_transposed

    !> Component after component, from point after point.
    pure subroutine to_lanes(ndir, count, nstatv, du, statev, block)
        integer, intent(in) :: ndir, count, nstatv
        real(wp), intent(in) :: du(ndir, count), statev(nstatv, count)
        real(wp), intent(inout) :: block(apart, columns)
        integer :: i

        do i = 1, count
            block(i, at_du:at_du + ndir - 1) = du(:, i)
            block(i, at_statev:at_statev + statev_size - 1) = statev(:statev_size, i)
        end do
    end subroutine to_lanes

    !> Point after point, from component after component; points that were refused are left out.
    pure subroutine to_points(ndir, count, nstatv, status, block, statev, traction, tangent)
        integer, intent(in) :: ndir, count, nstatv
        integer, intent(in) :: status(count)
        real(wp), intent(in) :: block(apart, columns)
        real(wp), intent(inout) :: statev(nstatv, count), traction(ndir, count)
        real(wp), intent(inout) :: tangent(ndir, ndir, count)
        integer :: i, row

        do i = 1, count
            if (status(i) < 0) cycle
            statev(:statev_size, i) = block(i, at_statev:at_statev + statev_size - 1)
            traction(:, i) = block(i, at_traction:at_traction + ndir - 1)
            do row = 1, ndir
                tangent(:, row, i) = block(i, at_tangent + row - 1:at_tangent + ndir**2 - 1:ndir)
            end do
        end do
    end subroutine to_points

end submodule friction_points
