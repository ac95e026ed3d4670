!> Many contact points at once (public name and arguments: module friction_mod).
!>
!> Points are taken in blocks that stay in cache, shared out among threads. A vector kernel updates
!> whole blocks; the points that it leaves, and laws that it does not know, go through the routine
!> for one point. Each point is treated by itself: its result depends neither on its neighbours nor
!> on the number of threads.
submodule(friction_mod) friction_batch
    use, intrinsic :: iso_c_binding, only : c_double, c_int, c_int64_t, c_intptr_t, c_loc
    use friction_anisotropy, only : orthotropy
    use friction_law, only : law
    use friction_law_choice, only : choose_law, law_storage, prop_alpha_n, prop_alpha_t
    use friction_subloading_law, only : subloading_law
    use friction_threads, only : worth_threads
    implicit none

    integer, parameter :: lanes = 128         !! points of the kernel's block
    integer, parameter :: line = 8            !! numbers of a cache line
    integer, parameter :: few = 16 * lanes    !! points that are not worth a second thread

    !> What a call is about.
    type, extends(array_sizes) :: batch
        real(wp) :: dtime                    !! [T]
        logical :: vectors                   !! the kernel knows this law and these constants
        real(wp) :: constants(8)             !! for the kernel
    end type batch

    interface
        !> See module friction_batch_kernel.
        subroutine batch_kernel(stride, du, dtime, constants, statev, traction, tangent, left, &
            n_left) bind(C, name='stickslip_batch_kernel')
            import :: c_double, c_int, c_int64_t, lanes
            implicit none
            integer(c_int64_t), value, intent(in) :: stride
            real(c_double), intent(in) :: du(stride, *)
            real(c_double), value, intent(in) :: dtime
            real(c_double), intent(in) :: constants(8)
            real(c_double), intent(inout) :: statev(stride, *), traction(stride, *)
            real(c_double), intent(inout) :: tangent(stride, 3, *)
            integer(c_int), intent(out) :: left(lanes), n_left
        end subroutine batch_kernel
    end interface

contains

    module subroutine friction_update_batch(du, dtime, props, statev, traction, tangent, status)
        real(wp), intent(in), contiguous :: du(:, :), props(:)
        real(wp), intent(in) :: dtime
        real(wp), intent(inout), contiguous :: statev(:, :), traction(:, :), tangent(:, :, :)
        integer, intent(out), contiguous :: status(:)
        integer(int64) :: n
        integer :: ndir

        n = size(du, 1, int64)
        ndir = size(du, 2)
        status = friction_bad_size
        if (size(statev, 1, int64) /= n .or. size(traction, 1, int64) /= n &
            .or. size(tangent, 1, int64) /= n .or. size(status, 1, int64) /= n) return
        if (size(traction, 2) /= ndir .or. size(tangent, 2) /= ndir &
            .or. size(tangent, 3) /= ndir) return
        call update_arrays_batch(array_sizes(n, ndir, size(props), size(statev, 2)), du, dtime, &
            props, statev, traction, tangent, status)
    end subroutine friction_update_batch

    module subroutine update_arrays_batch(sizes, du, dtime, props, statev, traction, tangent, &
        status)
        type(array_sizes), intent(in) :: sizes
        real(wp), intent(in) :: du(sizes%points, sizes%ndir), dtime, props(sizes%nprops)
        real(wp), intent(inout) :: statev(sizes%points, sizes%nstatv)
        real(wp), intent(inout) :: traction(sizes%points, sizes%ndir)
        real(wp), intent(inout), target :: tangent(sizes%points, sizes%ndir, sizes%ndir)
        integer, intent(out) :: status(sizes%points)
        type(batch) :: this
        integer(int64) :: head, block, last_block

        if (sizes%points == 0) return
        if (sizes%ndir < 2 .or. sizes%ndir > 3) then
            status = friction_bad_size
            return
        end if
        this = batch(array_sizes=sizes, dtime=dtime, vectors=.false., constants=0.0_wp)
        call prepare_kernel(this, props)

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

    !> May the kernel be used? It takes the subloading law as its authors wrote it, without
    !> options, with constants of ordinary size.
    pure subroutine prepare_kernel(this, props)
        type(batch), intent(inout) :: this
        real(wp), intent(in) :: props(this%nprops)
        real(wp), parameter :: least = 1.0e-20_wp, most = 1.0e20_wp
        real(wp) :: statev(statev_size), traction(3), tangent(3, 3)
        type(law_storage), target :: storage
        class(law), pointer :: surface
        type(orthotropy) :: plane
        integer :: status

        if (this%nstatv < statev_size) return
        statev = 0.0_wp
        call update_arrays(array_sizes(1, 3, this%nprops, statev_size), &
            [0.0_wp, 0.0_wp, 0.0_wp], this%dtime, props, statev, traction, tangent, status)
        if (status < 0) return   ! point by point, they all say so
        call choose_law(this%nprops, props, storage, surface, plane, status)
        if (abs(plane%squeeze - 1.0_wp) > 0.0_wp) return
        select type (surface)
        type is (subloading_law)
            this%constants = [props(prop_alpha_n), props(prop_alpha_t), surface%mu_s, &
                surface%mu_k, surface%kappa, surface%xi, surface%m, surface%mu_0]
        class default
            return
        end select
        this%vectors = this%dtime < most .and. all(this%constants < most &
            .and. (this%constants > least .or. this%constants <= 0.0_wp))
    end subroutine prepare_kernel

    !> Points `first` to `last`, a block at most.
    subroutine update_range(this, first, last, du, props, statev, traction, tangent, status)
        type(batch), intent(in) :: this
        integer(int64), intent(in) :: first, last
        real(wp), intent(in) :: du(this%points, this%ndir), props(this%nprops)
        real(wp), intent(inout) :: statev(this%points, this%nstatv)
        real(wp), intent(inout) :: traction(this%points, this%ndir)
        real(wp), intent(inout) :: tangent(this%points, this%ndir, this%ndir)
        integer, intent(inout) :: status(this%points)
        integer(c_int) :: left(lanes), n_left
        integer(int64) :: i

        if (.not. this%vectors) then
            do i = first, last
                call update_point_of(this, i, du, props, statev, traction, tangent, status(i))
            end do
        else if (this%ndir == 3 .and. last - first == lanes - 1) then
            call batch_kernel(this%points, du(first, 1), this%dtime, this%constants, &
                statev(first, 1), traction(first, 1), tangent(first, 1, 1), left, n_left)
            if (n_left == 0) then
                status(first:last) = friction_ok
            else
                call update_copies(this, first, last, du, props, left, statev, traction, tangent, &
                    status)
            end if
        else if (last >= first) then
            left = 0
            call update_copies(this, first, last, du, props, left, statev, traction, tangent, &
                status)
        end if
    end subroutine update_range

    !> The same through a copy, filled up to a block of three components, without the points that
    !> the kernel leaves: those go one by one.
    subroutine update_copies(this, first, last, du, props, left, statev, traction, tangent, status)
        type(batch), intent(in) :: this
        integer(int64), intent(in) :: first, last
        real(wp), intent(in) :: du(this%points, this%ndir), props(this%nprops)
        integer(c_int), intent(inout) :: left(lanes)   !! 1 for a point known to be left, else 0
        real(wp), intent(inout) :: statev(this%points, this%nstatv)
        real(wp), intent(inout) :: traction(this%points, this%ndir)
        real(wp), intent(inout) :: tangent(this%points, this%ndir, this%ndir)
        integer, intent(inout) :: status(this%points)
        real(wp) :: du_(lanes, 3), statev_(lanes, statev_size), traction_(lanes, 3), &
            tangent_(lanes, 3, 3)
        integer(c_int) :: more(lanes), n_left
        integer(int64) :: i
        integer :: count, j, k

        count = int(last - first) + 1
        du_ = 0.0_wp
        statev_ = 0.0_wp
        du_(:count, :this%ndir) = du(first:last, :)
        statev_(:count, :) = statev(first:last, :statev_size)
        ! In a plane the routine for one point neither uses nor keeps this component, but checks it.
        if (this%ndir == 2) then
            do j = 1, lanes
                if (transfer(statev_(j, statev_u_et + 1), this%points) /= 0) left(j) = 1
            end do
        end if
        do
            do j = 1, lanes
                if (left(j) == 0) cycle
                du_(j, :) = 0.0_wp
                statev_(j, :) = 0.0_wp
            end do
            call batch_kernel(int(lanes, c_int64_t), du_, this%dtime, this%constants, statev_, &
                traction_, tangent_, more, n_left)
            if (n_left == 0) exit
            left = max(left, more)
        end do

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
        do j = 1, count
            i = first + j - 1
            status(i) = friction_ok
            if (left(j) > 0) call update_point_of(this, i, du, props, statev, traction, tangent, &
                status(i))
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
        real(wp), intent(in) :: du(this%points, this%ndir), props(this%nprops)
        real(wp), intent(inout) :: statev(this%points, this%nstatv)
        real(wp), intent(inout) :: traction(this%points, this%ndir)
        real(wp), intent(inout) :: tangent(this%points, this%ndir, this%ndir)
        integer, intent(out) :: status
        real(wp) :: du_(3), statev_(statev_size), traction_(3), tangent_(9)   ! the sizes in space
        integer :: j, k

        status = friction_bad_size
        if (this%nstatv < statev_size) return
        do j = 1, this%ndir
            du_(j) = du(i, j)
        end do
        statev_ = statev(i, :statev_size)
        call update_arrays(array_sizes(1, this%ndir, this%nprops, statev_size), du_, this%dtime, &
            props, statev_, traction_, tangent_, status)
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
