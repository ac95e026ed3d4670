!> The table of costs: on the screen, as text and as CSV.
module cost_table
    use, intrinsic :: iso_fortran_env, only : compiler_version, dp => real64, output_unit
    use agreement, only : deviation, merge_deviations
    implicit none
    private

    public :: cost_row, table

    !> One measurement.
    type :: cost_row
        character(len=:), allocatable :: routine, set
        integer :: n = 0              !! points
        integer :: threads = 1
        real(dp) :: median = 0.0_dp   !! [ns/point]
        real(dp) :: lowest = 0.0_dp   !! [ns/point]
        logical :: compared = .false.
        type(deviation) :: apart      !! from the scalar routine, where compared
    end type cost_row

    type :: table
        type(cost_row), allocatable :: rows(:)
        integer :: text = 0           !! unit
        integer :: csv = 0            !! unit
    contains
        procedure :: create
        procedure :: add
        procedure :: say
        procedure :: cost
        procedure :: worst
        procedure :: disturbed
        procedure :: finish
    end type table

    character(len=*), parameter :: blank = repeat(' ', 80)

contains

    !> Starts bench.txt and bench.csv in a directory, which exists, with the machine's description.
    subroutine create(self, directory)
        class(table), intent(out) :: self
        character(len=*), intent(in) :: directory

        allocate (self%rows(0))
        open (newunit=self%text, file=directory // '/bench.txt', status='replace', action='write')
        open (newunit=self%csv, file=directory // '/bench.csv', status='replace', action='write')
        write (self%csv, '(a)') 'routine,set,n,threads,ns_per_point,ns_lowest,memcpy_ratio,' &
            // 'traction_difference,state_difference,tangent_difference,failures,negative_slips'
        call self%say('processor: ' // processor_fact('model name') // '; ' // vectors())
        call self%say('compiler:  ' // compiler_version())
        call self%say('')
        call self%say(repeat(' ', 43) // 'ns/point          times    worst difference from ' &
            // 'scalar')
        call self%say('routine         set                N thr   median   lowest   memcpy ' &
            // ' traction    state  tangent   failed (slip < 0)')
    end subroutine create

    !> Adds a row and writes it.
    subroutine add(self, row)
        class(table), intent(inout) :: self
        type(cost_row), intent(in) :: row
        real(dp) :: copy
        type(cost_row), allocatable :: rows(:)

        allocate (rows(size(self%rows) + 1))
        rows(:size(self%rows)) = self%rows
        rows(size(rows)) = row
        call move_alloc(rows, self%rows)
        copy = self%cost('memcpy', '-', row%n, 1)
        call self%say(text_line(row, copy))
        write (self%csv, '(a)') csv_line(row, copy)
        flush (self%csv)
    end subroutine add

    !> A row for the eye; what does not apply is left empty.
    pure function text_line(row, copy) result(line)
        type(cost_row), intent(in) :: row
        real(dp), intent(in) :: copy              !! cost of memcpy [ns/point], < 0 unknown
        character(len=:), allocatable :: line
        character(len=120) :: buffer

        write (buffer, '(a16, a12, i9, i4, 2f9.2)') row%routine // blank, row%set // blank, row%n, &
            row%threads, row%median, row%lowest
        if (copy > 0.0_dp) write (buffer(60:68), '(f9.2)') row%median / copy
        if (row%compared) write (buffer(69:), '(1x, 3es9.1, i9, " (", i0, ")")') &
            row%apart%traction, row%apart%state, row%apart%tangent, row%apart%failures, &
            row%apart%backward
        line = trim(buffer)
    end function text_line

    !> A row as CSV; what does not apply is left empty.
    pure function csv_line(row, copy) result(line)
        type(cost_row), intent(in) :: row
        real(dp), intent(in) :: copy              !! cost of memcpy [ns/point], < 0 unknown
        character(len=:), allocatable :: line
        character(len=120) :: buffer

        write (buffer, '(a, ",", a, 2(",", i0))') row%routine, row%set, row%n, row%threads
        line = trim(buffer) // ',' // number(row%median) // ',' // number(row%lowest) // ','
        if (copy > 0.0_dp) line = line // number(row%median / copy)
        buffer = ',,,,,'
        if (row%compared) write (buffer, '(3(",", es8.2), 2(",", i0))') row%apart%traction, &
            row%apart%state, row%apart%tangent, row%apart%failures, row%apart%backward
        line = line // trim(buffer)
    end function csv_line

    pure function number(x) result(text)
        real(dp), intent(in) :: x
        character(len=:), allocatable :: text
        character(len=20) :: buffer

        write (buffer, '(f20.4)') x
        text = trim(adjustl(buffer))
    end function number

    !> A line of text, on the screen and in bench.txt.
    subroutine say(self, line)
        class(table), intent(in) :: self
        character(len=*), intent(in) :: line

        write (output_unit, '(a)') line
        write (self%text, '(a)') line
        flush (output_unit)
        flush (self%text)
    end subroutine say

    !> Median of a measurement in the table [ns/point]; -1 if it was not taken.
    pure function cost(self, routine, set, n, threads) result(median)
        class(table), intent(in) :: self
        character(len=*), intent(in) :: routine, set
        integer, intent(in) :: n         !! points
        integer, intent(in) :: threads
        real(dp) :: median
        integer :: i

        median = -1.0_dp
        do i = 1, size(self%rows)
            associate (row => self%rows(i))
                if (row%routine == routine .and. row%set == set .and. row%n == n &
                    .and. row%threads == threads) median = row%median
            end associate
        end do
    end function cost

    !> The worst of all comparisons of a routine.
    pure function worst(self, routine) result(apart)
        class(table), intent(in) :: self
        character(len=*), intent(in) :: routine
        type(deviation) :: apart
        integer :: i

        do i = 1, size(self%rows)
            if (self%rows(i)%routine == routine) apart = merge_deviations(apart, self%rows(i)%apart)
        end do
    end function worst

    !> Measurements that some other program had a part in: half of their repetitions took much
    !> longer than the shortest.
    pure function disturbed(self) result(number_of_rows)
        class(table), intent(in) :: self
        integer :: number_of_rows
        real(dp), parameter :: much = 1.25_dp

        number_of_rows = count(self%rows%median > much * self%rows%lowest)
    end function disturbed

    subroutine finish(self)
        class(table), intent(inout) :: self

        close (self%text)
        close (self%csv)
    end subroutine finish

    !> What Linux says of the first processor; empty where it says nothing.
    function processor_fact(key) result(fact)
        character(len=*), intent(in) :: key
        character(len=:), allocatable :: fact
        character(len=4096) :: line
        integer :: unit, status

        fact = ''
        open (newunit=unit, file='/proc/cpuinfo', status='old', action='read', iostat=status)
        if (status /= 0) return
        do
            read (unit, '(a)', iostat=status) line
            if (status /= 0) exit
            if (index(line, key) /= 1) cycle
            fact = trim(adjustl(line(index(line, ':') + 1:)))
            exit
        end do
        close (unit)
    end function processor_fact

    !> The widest vectors that the processor offers.
    function vectors() result(name)
        character(len=:), allocatable :: name
        character(len=:), allocatable :: flags

        flags = processor_fact('flags')
        name = 'neither AVX2 nor AVX-512 known of'
        if (index(flags, ' avx2') > 0) name = 'AVX2'
        if (index(flags, ' avx512f') > 0) name = 'AVX-512'
    end function vectors

end module cost_table
