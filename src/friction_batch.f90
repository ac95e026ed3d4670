!> Many contact points at once (public name and arguments: module friction_mod).
!>
!> Points are taken in blocks that stay in cache, shared out among threads. A vector kernel updates
!> whole blocks; the points that it leaves, and laws that it does not know, go through the routine
!> for one point. Each point is treated by itself: its result depends neither on its neighbours nor
!> on the number of threads.
submodule(friction_mod) friction_batch
    use, intrinsic :: iso_c_binding, only : c_double, c_int, c_int64_t, c_intptr_t, c_loc
    use friction_contact, only : point_open
    use friction_lane_block, only : block_task, c_mu_0, c_own, c_r_0, constants_source, &
        lane_none, lane_subloading, lanes, n_constants
    use friction_lane_constants, only : lane_plan, plan_lanes, spread_constants
    use friction_threads, only : worth_threads
    implicit none

    integer, parameter :: line = 8            !! numbers of a cache line
    integer, parameter :: few = 16 * lanes    !! points that are not worth a second thread
    integer, parameter :: columns_room = lanes * n_constants + line   !! to begin at a line

    !> What a call is about.
    type, extends(array_sizes) :: batch
        real(wp) :: dtime              !! [T]
        integer(int64) :: rows         !! of `props`: 1, or one for each point
        type(lane_plan) :: plan        !! the lanes of the law and its options
        logical :: plain               !! the subloading law without options, in space, the same
                                       !! constants for all: it has a kernel of its own
        real(wp) :: plain_constants(8)              !! for that kernel
        real(wp) :: viscous            !! stiffness of the damper, eta_t/dt [F/L^3]
        real(wp), pointer, contiguous :: columns(:)   !! constants of all points, if they share them
    end type batch

    interface
        !> See module friction_batch_kernel.
        subroutine batch_kernel(task, constants, du, statev, traction, tangent, left, n_left) &
            bind(C, name='stickslip_batch_kernel')
            import :: block_task, c_double, c_int, lanes, n_constants
            implicit none
            type(block_task), intent(in) :: task
            real(c_double), intent(in) :: constants(lanes, n_constants)
            real(c_double), intent(in) :: du(task%stride, *)
            real(c_double), intent(inout) :: statev(task%stride, *), traction(task%stride, *)
            real(c_double), intent(inout) :: tangent(task%stride, task%ndir, *)
            integer(c_int), intent(out) :: left(lanes), n_left
        end subroutine batch_kernel

        !> See module friction_constants_kernel.
        pure subroutine constants_kernel(source, stride, count, props, constants, options, left) &
            bind(C, name='stickslip_constants_kernel')
            import :: c_double, c_int, c_int64_t, constants_source, lanes, n_constants
            implicit none
            type(constants_source), intent(in) :: source
            integer(c_int64_t), value, intent(in) :: stride
            integer(c_int), value, intent(in) :: count
            real(c_double), intent(in) :: props(stride, *)
            real(c_double), intent(out) :: constants(lanes, n_constants)
            integer(c_int), intent(out) :: options, left(lanes)
        end subroutine constants_kernel

        !> See module friction_subloading_kernel.
        subroutine subloading_kernel(stride, du, dtime, constants, statev, traction, tangent, &
            left, n_left) bind(C, name='stickslip_subloading_kernel')
            import :: c_double, c_int, c_int64_t, lanes
            implicit none
            integer(c_int64_t), value, intent(in) :: stride
            real(c_double), intent(in) :: du(stride, *)
            real(c_double), value, intent(in) :: dtime
            real(c_double), intent(in) :: constants(8)
            real(c_double), intent(inout) :: statev(stride, *), traction(stride, *)
            real(c_double), intent(inout) :: tangent(stride, 3, *)
            integer(c_int), intent(out) :: left(lanes), n_left
        end subroutine subloading_kernel
    end interface

contains

    module subroutine update_batch_alike(du, dtime, props, statev, traction, tangent, status)
        real(wp), intent(in), contiguous :: du(:, :), props(:)
        real(wp), intent(in) :: dtime
        real(wp), intent(inout), contiguous :: statev(:, :), traction(:, :), tangent(:, :, :)
        integer, intent(out), contiguous :: status(:)

        status = friction_bad_size
        if (.not. fit(du, statev, traction, tangent, size(status, 1, int64))) return
        call update_arrays_batch(array_sizes(size(du, 1, int64), size(du, 2), size(props), &
            size(statev, 2)), du, dtime, 1_int64, props, statev, traction, tangent, status)
    end subroutine update_batch_alike

    module subroutine update_batch_varied(du, dtime, props, statev, traction, tangent, status)
        real(wp), intent(in), contiguous :: du(:, :), props(:, :)
        real(wp), intent(in) :: dtime
        real(wp), intent(inout), contiguous :: statev(:, :), traction(:, :), tangent(:, :, :)
        integer, intent(out), contiguous :: status(:)
        integer(int64) :: n

        n = size(du, 1, int64)
        status = friction_bad_size
        if (size(props, 1, int64) /= n) return
        if (.not. fit(du, statev, traction, tangent, size(status, 1, int64))) return
        call update_arrays_batch(array_sizes(n, size(du, 2), size(props, 2), size(statev, 2)), &
            du, dtime, n, props, statev, traction, tangent, status)
    end subroutine update_batch_varied

    !> Do the arrays of a batch fit together?
    pure function fit(du, statev, traction, tangent, n)
        real(wp), intent(in), contiguous :: du(:, :), statev(:, :), traction(:, :), tangent(:, :, :)
        integer(int64), intent(in) :: n   !! places for the status
        logical :: fit
        integer :: ndir

        ndir = size(du, 2)
        fit = size(du, 1, int64) == n .and. size(statev, 1, int64) == n &
            .and. size(traction, 1, int64) == n .and. size(tangent, 1, int64) == n &
            .and. size(traction, 2) == ndir .and. size(tangent, 2) == ndir &
            .and. size(tangent, 3) == ndir
    end function fit

    module subroutine update_arrays_batch(sizes, du, dtime, rows, props, statev, traction, &
        tangent, &
        status)
        type(array_sizes), intent(in) :: sizes
        real(wp), intent(in) :: du(sizes%points, sizes%ndir), dtime
        integer(int64), intent(in) :: rows
        real(wp), intent(in) :: props(rows, sizes%nprops)
        real(wp), intent(inout) :: statev(sizes%points, sizes%nstatv)
        real(wp), intent(inout) :: traction(sizes%points, sizes%ndir)
        real(wp), intent(inout), target :: tangent(sizes%points, sizes%ndir, sizes%ndir)
        integer, intent(out) :: status(sizes%points)
        type(batch) :: this
        real(wp), target :: room(columns_room)
        integer(int64) :: head, block, last_block

        if (sizes%points == 0) return
        if (sizes%ndir < 2 .or. sizes%ndir > 3) then
            status = friction_bad_size
            return
        end if
        call prepare(this, room, sizes, dtime, rows, props)

        ! Blocks begin where a cache line begins, but for the first.
        head = modulo(-transfer(c_loc(tangent), 0_c_intptr_t) / 8, int(line, c_intptr_t))
        last_block = (sizes%points - head + lanes - 1) / lanes
        if (.not. worth_threads(sizes%points, few)) then
            do block = 0, last_block
                call update_block(block)
            end do
        else
            !$omp parallel do schedule(static)
            do block = 0, last_block
                call update_block(block)
            end do
            !$omp end parallel do
        end if

    contains

        subroutine update_block(block)
            integer(int64), intent(in) :: block
            integer(int64) :: first

            first = head + (block - 1) * lanes + 1
            call update_range(this, max(1_int64, first), min(sizes%points, first + lanes - 1), &
                du, props, statev, traction, tangent, status)
        end subroutine update_block

    end subroutine update_arrays_batch

    !> Plans the lanes, by the first point whose constants are valid.
    pure subroutine prepare(this, room, sizes, dtime, rows, props)
        type(batch), intent(inout) :: this   !! out; (out) would copy its first values once more
        real(wp), intent(inout), target :: room(columns_room)   !! for what it points to
        type(array_sizes), intent(in) :: sizes
        real(wp), intent(in) :: dtime
        integer(int64), intent(in) :: rows
        real(wp), intent(in) :: props(rows, sizes%nprops)
        real(wp), parameter :: most = 1.0e20_wp
        real(wp) :: statev(statev_size), traction(3), tangent(3, 3)
        integer(int64) :: row
        integer :: status

        this%array_sizes = sizes
        this%dtime = dtime
        this%rows = rows
        this%columns => room(line_start(room):)
        this%plain = .false.
        this%plan%kind = lane_none
        this%viscous = 0.0_wp
        if (sizes%nstatv < statev_size) return
        do row = 1, rows
            statev = 0.0_wp
            call update_arrays(array_sizes(1, 3, sizes%nprops, statev_size), &
                [0.0_wp, 0.0_wp, 0.0_wp], dtime, props(row, :), statev, traction, tangent, status)
            if (status >= 0) exit
        end do
        if (status < 0) return   ! point by point, they all say so
        call plan_lanes(sizes%nprops, props(row, :), this%plan)
        if (.not. dtime < most) this%plan%kind = lane_none
        if (this%plan%needs_time .and. .not. dtime > 1.0_wp / most) this%plan%kind = lane_none
        if (this%plan%damping > 0.0_wp .and. dtime > 0.0_wp) this%viscous = this%plan%damping &
            / max(dtime, 2.0_wp**(-1000) * this%plan%damping)   ! no overflow
        if (.not. this%viscous < most) this%plan%kind = lane_none
        this%plain = this%plan%kind == lane_subloading .and. rows == 1 .and. sizes%ndir == 3 &
            .and. this%plan%options == 0 .and. max(this%plan%cohesion, this%viscous) <= 0.0_wp
        if (this%plain) then
            associate (value => this%plan%source%value)
                this%plain_constants = [value(:c_mu_0 - 1), value(c_own:c_own + 4), value(c_mu_0)]
            end associate
        else if (this%plan%kind /= lane_none) then
            call spread_constants(this%plan, this%columns)
        end if
    end subroutine prepare

    !> Points `first` to `last`, a block at most.
    subroutine update_range(this, first, last, du, props, statev, traction, tangent, status)
        type(batch), intent(in) :: this
        integer(int64), intent(in) :: first, last
        real(wp), intent(in) :: du(this%points, this%ndir), props(this%rows, this%nprops)
        real(wp), intent(inout) :: statev(this%points, this%nstatv)
        real(wp), intent(inout) :: traction(this%points, this%ndir)
        real(wp), intent(inout) :: tangent(this%points, this%ndir, this%ndir)
        integer, intent(inout) :: status(this%points)
        real(wp), target :: room(columns_room)
        integer(c_int) :: options, left(lanes)
        integer(int64) :: i
        integer :: start

        if (last < first) return
        if (this%plan%kind == lane_none) then
            do i = first, last
                call update_point_of(this, i, du, props, statev, traction, tangent, status(i))
            end do
        else if (this%rows > 1) then
            start = line_start(room)
            call constants_kernel(this%plan%source, this%rows, int(last - first, c_int) + 1_c_int, &
                props(first, 1), room(start), options, left)
            call update_lanes(this, first, last, room(start), options, du, props, left, statev, &
                traction, tangent, status)
        else
            left = 0
            call update_lanes(this, first, last, this%columns, this%plan%options, du, props, &
                left, statev, traction, tangent, status)
        end if
    end subroutine update_range

    !> The first number that begins a cache line.
    pure function line_start(room) result(start)
        real(wp), intent(in), target :: room(line)
        integer :: start

        start = 1 + int(modulo(-transfer(c_loc(room), 0_c_intptr_t) / 8, int(line, c_intptr_t)))
    end function line_start

    !> The same by lanes; points that they leave go one by one.
    subroutine update_lanes(this, first, last, constants, options, du, props, left, statev, &
        traction, tangent, status)
        type(batch), intent(in) :: this
        integer(int64), intent(in) :: first, last
        real(wp), intent(in) :: constants(lanes, n_constants)
        integer(c_int), intent(in) :: options   !! sum of those that a point has
        real(wp), intent(in) :: du(this%points, this%ndir), props(this%rows, this%nprops)
        integer(c_int), intent(inout) :: left(lanes)   !! 1 for a point known to be left, else 0
        real(wp), intent(inout) :: statev(this%points, this%nstatv)
        real(wp), intent(inout) :: traction(this%points, this%ndir)
        real(wp), intent(inout) :: tangent(this%points, this%ndir, this%ndir)
        integer, intent(inout) :: status(this%points)
        integer(c_int) :: n_left
        integer(int64) :: i

        status(first:last) = friction_ok
        if (last - first == lanes - 1 .and. sum(left) == 0) then
            call call_kernel(this, this%points, constants, options, du(first, 1), &
                statev(first, 1), traction(first, 1), tangent(first, 1, 1), left, n_left)
            if (n_left == 0) return
        end if
        call update_copies(this, first, last, constants, options, du, left, statev, traction, &
            tangent)
        do i = first, last
            if (left(i - first + 1) > 0) call update_point_of(this, i, du, props, statev, &
                traction, &
                tangent, status(i))
        end do
    end subroutine update_lanes

    subroutine call_kernel(this, stride, constants, options, du, statev, traction, tangent, left, &
        n_left)
        type(batch), intent(in) :: this
        integer(int64), intent(in) :: stride   !! from one component to the next
        real(wp), intent(in) :: constants(lanes, n_constants), du(stride, *)
        integer(c_int), intent(in) :: options
        real(wp), intent(inout) :: statev(stride, *), traction(stride, *)
        real(wp), intent(inout) :: tangent(stride, this%ndir, *)
        integer(c_int), intent(out) :: left(lanes), n_left

        if (this%plain) then
            call subloading_kernel(stride, du, this%dtime, this%plain_constants, statev, traction, &
                tangent, left, n_left)
        else
            call batch_kernel(task_of(this, stride, options), constants, du, statev, traction, &
                tangent, left, n_left)
        end if
    end subroutine call_kernel

    pure function task_of(this, stride, options) result(task)
        type(batch), intent(in) :: this
        integer(int64), intent(in) :: stride   !! from one component to the next
        integer(c_int), intent(in) :: options
        type(block_task) :: task

        task = block_task(stride, this%plan%kind, int(this%ndir, c_int), &
            merge(this%plan%source%n_own, 0_c_int, this%rows > 1), options, this%dtime, &
            this%plan%cohesion, this%viscous)
    end function task_of

    !> The same through a copy, filled up to a block, without the points that the kernel leaves.
    subroutine update_copies(this, first, last, constants, options, du, left, statev, traction, &
        tangent)
        type(batch), intent(in) :: this
        integer(int64), intent(in) :: first, last
        real(wp), intent(in) :: constants(lanes, n_constants)
        integer(c_int), intent(in) :: options
        real(wp), intent(in) :: du(this%points, this%ndir)
        integer(c_int), intent(inout) :: left(lanes)   !! 1 for a point known to be left, else 0
        real(wp), intent(inout) :: statev(this%points, this%nstatv)
        real(wp), intent(inout) :: traction(this%points, this%ndir)
        real(wp), intent(inout) :: tangent(this%points, this%ndir, this%ndir)
        real(wp) :: constants_(lanes, n_constants), du_(lanes, this%ndir)
        real(wp) :: statev_(lanes, statev_size)
        real(wp) :: traction_(lanes, this%ndir), tangent_(lanes, this%ndir, this%ndir)
        integer(c_int) :: more(lanes), n_left
        integer :: count, used, pass, j, k

        count = int(last - first) + 1
        du_ = 0.0_wp
        statev_ = 0.0_wp
        ! no column that is not in use: copies of signalling numbers stay in vector registers
        used = c_own + this%plan%source%n_own - 1
        if (this%plain) used = 0
        constants_(:, :used) = constants(:, :used)
        du_(:count, :) = du(first:last, :)
        statev_(:count, :) = statev(first:last, :statev_size)
        do pass = 1, lanes
            do j = 1, lanes
                if (left(j) == 0 .and. j <= count) cycle   ! else an open point harms nobody
                constants_(j, :used) = this%plan%source%value(:used)
                du_(j, :) = 0.0_wp
                statev_(j, :) = 0.0_wp
                statev_(j, statev_status) = point_open
                statev_(j, statev_u_n) = 1.0_wp   ! not one that just touches
                statev_(j, statev_mu) = this%plan%source%value(c_mu_0)
                statev_(j, statev_r) = this%plan%source%value(c_r_0)
            end do
            call call_kernel(this, int(lanes, int64), constants_, options, du_, statev_, &
                traction_, tangent_, more, n_left)
            if (n_left == 0) exit
            left = max(left, more)
        end do
        if (n_left > 0) left = 1_c_int

        ! Column by column: a point's components can be far apart.
        do k = 1, statev_size
            call give_back(count, left, statev_(:, k), statev(first, k))
        end do
        do k = 1, this%ndir
            call give_back(count, left, traction_(:, k), traction(first, k))
            do j = 1, this%ndir
                call give_back(count, left, tangent_(:, j, k), tangent(first, j, k))
            end do
        end do
    end subroutine update_copies

    !> One component of the points that the kernel has taken.
    pure subroutine give_back(count, left, from, to)
        integer, intent(in) :: count
        integer(c_int), intent(in) :: left(lanes)
        real(wp), intent(in) :: from(lanes)
        real(wp), intent(inout) :: to(count)
        integer :: j

        do j = 1, count
            if (left(j) == 0) to(j) = from(j)
        end do
    end subroutine give_back

    !> Point `i` alone.
    pure subroutine update_point_of(this, i, du, props, statev, traction, tangent, status)
        type(batch), intent(in) :: this
        integer(int64), intent(in) :: i
        real(wp), intent(in) :: du(this%points, this%ndir), props(this%rows, this%nprops)
        real(wp), intent(inout) :: statev(this%points, this%nstatv)
        real(wp), intent(inout) :: traction(this%points, this%ndir)
        real(wp), intent(inout) :: tangent(this%points, this%ndir, this%ndir)
        integer, intent(out) :: status
        real(wp) :: du_(3), statev_(statev_size), traction_(3), tangent_(9)   ! the sizes in space
        integer(int64) :: row   ! gfortran 14 checks bounds before it has computed an expression
        integer :: j, k

        status = friction_bad_size
        if (this%nstatv < statev_size) return
        row = min(i, this%rows)
        do j = 1, this%ndir
            du_(j) = du(i, j)
        end do
        statev_ = statev(i, :statev_size)
        call update_arrays(array_sizes(1, this%ndir, this%nprops, statev_size), du_, this%dtime, &
            props(row, :), statev_, traction_, tangent_, status)
        if (status < 0) return
        statev(i, :statev_size) = statev_
        do k = 1, this%ndir
            traction(i, k) = traction_(k)
            do j = 1, this%ndir
                tangent(i, j, k) = tangent_((k - 1) * this%ndir + j)
            end do
        end do
    end subroutine update_point_of

end submodule friction_batch
