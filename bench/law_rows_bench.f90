!> What an update of many points costs under each law and option, in one thread: law_rows_bench
!> (docs/performance.md). Rows of a size take turns, so that a busy machine disturbs all alike; what
!> counts is the lowest processor time of each.
program law_rows_bench
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use friction_mod, only : friction_update, friction_update_batch, friction_update_points
    use omp_lib, only : omp_set_num_threads
    implicit none

    integer, parameter :: sizes(3) = [1000, 10000, 100000], most_constants = 16
    integer, parameter :: numbers = 23   !! of a point, read or written
    integer, parameter :: few = 20000    !! points one by one
    !> Ways to update: a batch with one set of constants or with each point's own, points one after
    !> another in memory, the routine for one point.
    integer, parameter :: alike = 1, varied = 2, point_major = 3, one_by_one = 4, ways = 4
    real(dp), parameter :: dt = 1.0e-3_dp, alpha = 1000.0_dp

    !> A law with its option, and points that have been sliding under it.
    type :: row
        character(len=21) :: name
        integer :: n_props
        real(dp) :: props(most_constants)
        real(dp), allocatable :: du(:, :), statev(:, :), own(:, :)
        real(dp) :: lowest(ways) = huge(1.0_dp)   !! processor time of each way [s]
    end type row

    type(row) :: rows(19)
    !> Results, component after component and point after point: allocated once for a size, so that
    !> no time is spent on fresh memory.
    real(dp), allocatable :: statev(:, :), traction(:, :), tangent(:, :, :)
    real(dp), allocatable :: du_(:, :), statev_(:, :), traction_(:, :), tangent_(:, :, :)
    integer, allocatable :: status(:)
    real(dp) :: copy
    integer :: k, i

    call omp_set_num_threads(1)
    do k = 1, size(sizes)
        call list_rows()
        do i = 1, size(rows)
            call draw_points(sizes(k), rows(i))
        end do
        call make_room(sizes(k))
        call measure(sizes(k), max(15, 300000 / sizes(k)))
        call show(sizes(k))
    end do

contains

    subroutine list_rows()
        real(dp), parameter :: sub(8) = [1.0_dp, alpha, alpha, 0.4_dp, 0.2_dp, 10.0_dp, 10.0_dp, &
            1000.0_dp]
        real(dp), parameter :: creep(8) = [4.0_dp, alpha, alpha, 0.01_dp, 0.015_dp, 0.01_dp, &
            1.0e-3_dp, 0.3_dp]

        rows(1) = row_of('subloading', sub)
        rows(2) = row_of('Coulomb', [2.0_dp, alpha, alpha, 0.3_dp])
        rows(3) = row_of('slip-weakening', [5.0_dp, alpha, alpha, 0.4_dp, 0.2_dp, 0.05_dp])
        rows(4) = row_of('static-kinetic', [3.0_dp, alpha, alpha, 0.4_dp, 0.2_dp, 1.0_dp])
        rows(5) = row_of('exact rate', [sub, 0.4_dp, 1.0_dp])
        rows(6) = row_of('cotangent', [sub, 0.4_dp, 0.0_dp, 1.0_dp])
        rows(7) = row_of('reciprocal', [sub, 0.4_dp, 0.0_dp, 2.0_dp])
        rows(8) = row_of('capped', [sub, 0.4_dp, 0.0_dp, 0.0_dp, 8.0_dp])
        rows(9) = row_of('radial orthotropic', [sub, 0.4_dp, 0.0_dp, 0.0_dp, 0.0_dp, 0.5_dp, &
            1.0_dp])
        rows(10) = row_of('rate-state, ageing', creep)
        rows(11) = row_of('rate-state, slip law', [creep, 1.0_dp])
        rows(12) = row_of('exact rate, capped', [sub, 0.4_dp, 1.0_dp, 0.0_dp, 8.0_dp])
        rows(13) = row_of('rate-state, capped', [creep, 0.0_dp, 1.0_dp, 16.0_dp])
        rows(14) = row_of('slip-weakening, heals', [6.0_dp, alpha, alpha, 0.4_dp, 0.2_dp, 0.05_dp, &
            10.0_dp])
        rows(15) = row_of('flash heating', [7.0_dp, creep(2:8), 0.2_dp, 0.1_dp])
        rows(16) = row_of('Linker-Dieterich', [8.0_dp, creep(2:8), 0.1_dp])
        rows(17) = row_of('same, slip law', [8.0_dp, creep(2:8), 0.1_dp, 1.0_dp])
        rows(18) = row_of('cohesion', [sub, 0.4_dp, 0.0_dp, 0.0_dp, 0.0_dp, 0.0_dp, 0.0_dp, 1.0_dp])
        rows(19) = row_of('damper', [sub, 0.4_dp, 0.0_dp, 0.0_dp, 0.0_dp, 0.0_dp, 0.0_dp, 0.0_dp, &
            0.1_dp])
    end subroutine list_rows

    function row_of(name, props) result(this)
        character(len=*), intent(in) :: name
        real(dp), intent(in) :: props(:)
        type(row) :: this

        this%name = name
        this%n_props = size(props)
        this%props(:size(props)) = props
    end function row_of

    !> Points on their way to slip or at it: pressures 1 to 100, increments 1e-6 to 1e-4, up to half
    !> a right angle off the traction.
    subroutine draw_points(n, this)
        integer, intent(in) :: n
        type(row), intent(inout) :: this
        real(dp) :: u(7), pressure, mu, internal, traction, length, angle
        integer :: law, last, j

        law = nint(this%props(1))
        allocate (this%du(n, 3), this%statev(n, 8))
        this%own = spread(this%props(:this%n_props), 1, n)
        do j = 1, n
            call random_number(u)
            pressure = 1.0_dp + 99.0_dp * u(1)
            mu = merge(0.4_dp, 0.3_dp, law == 3 .or. law == 5 .or. law == 6)
            internal = 0.0_dp
            if (law == 1) then
                mu = 0.2_dp + 0.2_dp * u(2)
                internal = 0.05_dp + 0.95_dp * u(3)
                traction = internal * mu * pressure
            else if (law == 4 .or. law >= 7) then
                internal = 10.0_dp**(2.0_dp * u(3))
                traction = (0.28_dp + 0.04_dp * u(2)) * pressure
            else
                if (law == 5 .or. law == 6) internal = 0.05_dp * u(3)
                traction = (mu - 4.0_dp * internal) * pressure * (1.0_dp - 1.0e-6_dp * u(2))
            end if
            if (this%n_props == 12) traction = min(traction, this%props(12))
            if (this%n_props == 11 .and. law == 4) traction = min(traction, this%props(11))
            if (this%n_props == 14) traction = 0.7_dp * traction
            angle = 6.3_dp * u(4)
            this%statev(j, :) = [2.0_dp, -pressure / alpha, traction / alpha * cos(angle), &
                traction / alpha * sin(angle), mu, internal, 0.0_dp, 0.0_dp]
            length = 10.0_dp**(2.0_dp * u(5) - 6.0_dp)
            angle = angle + u(6) - 0.5_dp
            this%du(j, :) = [0.0_dp, length * cos(angle), length * sin(angle)]
            ! no two points alike, but nearly: their updates are those of the other rows
            this%own(j, 3) = alpha * (1.0_dp + 1.0e-9_dp * u(7))
            last = min(8, this%n_props)
            this%own(j, 6:last) = this%props(6:last) * (1.0_dp + 1.0e-9_dp * u(2:last - 4))
        end do
    end subroutine draw_points

    subroutine make_room(n)
        integer, intent(in) :: n

        if (allocated(status)) deallocate (statev, traction, tangent, du_, statev_, traction_, &
            tangent_, status)
        allocate (statev(n, 8), traction(n, 3), tangent(n, 3, 3))
        allocate (du_(3, n), statev_(8, n), traction_(3, n), tangent_(3, 3, n), status(n))
    end subroutine make_room

    subroutine measure(n, repetitions)
        integer, intent(in) :: n, repetitions
        real(dp), allocatable :: from(:, :), to(:, :)
        real(dp) :: began, at_end
        integer :: repetition, i, way

        allocate (from(n, numbers), to(n, numbers))
        call random_number(from)
        copy = huge(copy)
        do repetition = 1, repetitions
            do i = 1, 2   ! the first brings the arrays into the caches
                call cpu_time(began)
                to = from
                call cpu_time(at_end)
                from(1, 1) = 0.5_dp * to(n, numbers)
            end do
            copy = min(copy, at_end - began)
            do i = 1, size(rows)
                do way = 1, ways
                    ! A first time, untimed, brings its arrays into the caches.
                    if (way < one_by_one) call update(way, n, rows(i), at_end)
                    if (way < one_by_one .or. repetition <= 3) then
                        call update(way, n, rows(i), at_end)
                        rows(i)%lowest(way) = min(rows(i)%lowest(way), at_end)
                    end if
                end do
            end do
        end do
    end subroutine measure

    !> All points of a row in one of the ways, and the processor time [s].
    subroutine update(way, n, this, spent)
        integer, intent(in) :: way, n
        type(row), intent(in) :: this
        real(dp), intent(out) :: spent
        real(dp) :: s(8), t(3), k(3, 3), began
        integer :: j

        if (way <= varied) then
            statev = this%statev
        else
            du_ = transpose(this%du)
            statev_ = transpose(this%statev)
        end if
        associate (props => this%props(:this%n_props))
            call cpu_time(began)
            select case (way)
            case (alike)
                call friction_update_batch(this%du, dt, props, statev, traction, tangent, status)
            case (varied)
                call friction_update_batch(this%du, dt, this%own, statev, traction, tangent, status)
            case (point_major)
                call friction_update_points(du_, dt, props, statev_, traction_, tangent_, status)
            case default
                do j = 1, min(n, few)
                    s = statev_(:, j)
                    call friction_update(du_(:, j), dt, props, s, t, k, status(j))
                end do
            end select
            call cpu_time(spent)
        end associate
        spent = spent - began
        if (way == one_by_one) spent = spent * n / min(n, few)
        if (any(status < 0)) error stop 'an update failed'
    end subroutine update

    subroutine show(n)
        integer, intent(in) :: n
        integer :: i

        print '(/, i0, a, f6.1, a)', n, ' points; memcpy of 23 numbers a point: ', copy / n &
            * 1.0e9_dp, ' ns a point'
        print '(a)', '                          ns  / memcpy  / subloading  own constants' &
            // '      C order  scalar, ns'
        do i = 1, size(rows)
            associate (t => rows(i)%lowest)
                print '(a21, f7.1, f10.2, f14.2, f15.2, f13.2, f12.1)', rows(i)%name, &
                    t(alike) / n * 1.0e9_dp, t(alike) / copy, t(alike) / rows(1)%lowest(alike), &
                    t(varied) / t(alike), t(point_major) / t(alike), t(one_by_one) / n * 1.0e9_dp
            end associate
        end do
    end subroutine show

end program law_rows_bench
